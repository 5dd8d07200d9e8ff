// On paper a page is light, whatever it is on the screen.
(() => {
  const page = document.documentElement;
  let chosen = null;
  addEventListener("beforeprint", () => { chosen = page.dataset.theme; page.dataset.theme = "light"; });
  addEventListener("afterprint", () => { if (chosen) page.dataset.theme = chosen; });
})();
