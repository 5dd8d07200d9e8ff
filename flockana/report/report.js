// The report's page: runs are decoded when their section opens; the table of verdicts is filtered.
const players = new WeakMap();

function ready(details) {
  const place = details.querySelector(".player"), run = details.querySelector("script.run");
  if (!details.open || !place || players.has(details)) return;
  players.set(details, flockanaPlayer(place, bytesOfText(run.textContent)));
}
document.querySelectorAll("section.scenario > details").forEach((details) => {
  details.addEventListener("toggle", () => {
    ready(details);
    if (!details.open && players.has(details)) players.get(details).then((player) => player && player.pause());
  });
  ready(details);
});

function follow() {  // an address within a folded section opens it
  let name = "";
  try { name = decodeURIComponent(location.hash.slice(1)); } catch { return; }  // no address of ours
  const target = name && document.getElementById(name);
  if (!target) return;
  for (let node = target; node; node = node.parentElement) if (node.tagName === "DETAILS") node.open = true;
  target.scrollIntoView();
}
addEventListener("hashchange", follow);
follow();

const form = document.getElementById("filter"), more = document.getElementById("all-rows"), FIRST = 40;
let whole = document.querySelectorAll(".summary tr[data-status]").length <= 1.5 * FIRST;
function filter() {
  const { words, source, status, rigour } = Object.fromEntries(new FormData(form));
  const wanted = words.toLowerCase().split(/\s+/).filter(Boolean), shown = new Set();
  const asked = whole || source || status || rigour || wanted.length;
  let count = 0, all = 0;
  for (const body of document.querySelectorAll(".summary tbody")) {
    let any = false, early = false;
    for (const row of body.querySelectorAll("tr[data-status]")) {
      const text = `${body.dataset.name} ${row.textContent} ${row.dataset.words}`.toLowerCase(), data = row.dataset;
      const fits = (!source || data.source === source) && (!status || data.status === status)
        && (!rigour || data.rigour === rigour) && wanted.every((word) => text.includes(word));
      row.hidden = !fits;
      row.classList.toggle("later", !asked && count >= FIRST);
      if (fits) { any = true; early ||= asked || count < FIRST; count++; shown.add(data.subject); }
      all++;
    }
    body.hidden = !any;
    body.classList.toggle("later", !early);
  }
  for (const section of document.querySelectorAll("section.scenario"))
    section.hidden = !shown.has(section.dataset.name);
  more.hidden = Boolean(asked);
  form.querySelector("output").textContent = `${count} of ${all} verdicts`;
}
more.addEventListener("click", () => { whole = true; filter(); });
form.hidden = false;
form.addEventListener("input", filter);
form.addEventListener("submit", (event) => event.preventDefault());
filter();

function reachable() {  // what scrolls in itself can have the focus
  for (const box of document.querySelectorAll(".wide, figure"))
    if (box.scrollWidth > box.clientWidth + 1) box.tabIndex = 0; else box.removeAttribute("tabindex");
}
reachable();
addEventListener("resize", reachable);
document.addEventListener("toggle", reachable, true);

const openAll = document.getElementById("open-all");
if (openAll) {
  openAll.hidden = false;
  openAll.addEventListener("click", () => {
    const close = openAll.textContent === "Close all";
    document.querySelectorAll("section.scenario > details").forEach((details) => { details.open = !close; });
    openAll.textContent = close ? "Open all" : "Close all";
  });
}
