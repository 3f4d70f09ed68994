// What scrolls sideways can be scrolled by keys. The theme wraps tables in the browser, after the page
// was built, and takes code out of the order of keys where nothing hovers: the builder cannot do it.
window.addEventListener("load", () => {
  for (const wrap of document.querySelectorAll(".md-typeset__scrollwrap")) {
    wrap.tabIndex = 0;
  }
  for (const code of document.querySelectorAll("pre > code")) {
    const reach = () => {
      if (code.scrollWidth > code.clientWidth && code.tabIndex !== 0) code.tabIndex = 0;
      // a button to copy is no landmark
      code.parentElement.querySelector("nav")?.setAttribute("role", "none");
    };
    const changes = { subtree: true, childList: true, attributeFilter: ["tabindex"] };
    new MutationObserver(reach).observe(code.parentElement, changes);
    reach();
  }
});
