"use strict";
(() => {
  const root = document.documentElement;
  root.classList.add("scripted");
  const panels = [...document.querySelectorAll("figure[data-observable]")];
  const observable = document.getElementById("observable");
  const against = document.getElementById("against");
  const told = document.getElementById("told");
  const show = () => {
    const wanted = against ? against.value : "";
    for (const panel of panels) {
      const name = panel.dataset.observable;
      const own = panels.filter((p) => p.dataset.observable === name);
      const has = own.some((p) => p.dataset.against === wanted);
      const axis = has ? wanted : own[0].dataset.against;
      const seen = !observable || !observable.value || observable.value === name;
      panel.hidden = !(seen && panel.dataset.against === axis);
    }
  };
  for (const choice of [observable, against]) if (choice) choice.addEventListener("change", show);
  show();
  const tell = (event) => {
    const point = event.target.closest ? event.target.closest(".point") : null;
    if (point) told.textContent = point.querySelector("title").textContent;
  };
  for (const kind of ["pointerover", "click"]) document.addEventListener(kind, tell);
  const open = () => { for (const part of document.querySelectorAll("details")) part.open = true; };
  window.addEventListener("beforeprint", open);
})();
