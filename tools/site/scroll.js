// Tables that scroll sideways can be scrolled by keys. The theme wraps them in the browser, after
// the page was built, so that the builder cannot do it.
window.addEventListener("load", () => {
  for (const wrap of document.querySelectorAll(".md-typeset__scrollwrap")) {
    wrap.tabIndex = 0;
  }
});
