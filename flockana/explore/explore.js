// The page: its case, the socket that answers it, and the player of what comes.
const { first, groups } = JSON.parse(document.getElementById("data").textContent);
const by = (id) => document.getElementById(id);
const said = by("said"), wrong = by("wrong"), place = by("player");
const say = (text) => { said.textContent = text; };
const fail = (text) => { wrong.hidden = !text; wrong.textContent = text || ""; };

let player = null, number = 0, waiting = false, dirty = false, asked = null, fresh = true, since = 0;
const state = { touched: false, playing: !matchMedia("(prefers-reduced-motion: reduce)").matches, time: null, end: false };
const form = explorerForm(by("form"), groups, ask);
const handles = explorerHandles(place, () => player && { ...player, time: () => state.time }, form, () => { state.touched = true; }, () => {
  player.show(player.run.t[0]); state.time = player.run.t[0]; state.end = false; state.playing = false;
  say("back at the start of the run: here agents can be dragged");
});
const answers = explorerAnswers(by("verdicts"), by("poles"), by("strip"));

const history_ = explorerHistory((one) => ask(one, false, true));

function ask(next, anew = false, kept = false) {
  if (asked) history_.add({ ...next });
  if (kept && next.name !== asked.name) anew = true;
  asked = { ...next };
  if (anew) { fresh = true; state.touched = false; state.time = null; state.end = false; }
  form.show(asked, null);
  history.replaceState(null, "", `#${encodeURIComponent(JSON.stringify(asked))}`);
  send();
}
function send() {  // the newest case, and no other before the first frames of the last came
  dirty = true;
  if (waiting || !socket || socket.readyState !== WebSocket.OPEN) return;
  by("cancel").disabled = false;
  dirty = false; waiting = true; number += 1; marks = []; since = performance.now();
  say("running …");
  slow(number);
  socket.send(JSON.stringify({ number, case: asked }));
}
function slow(mine) {
  setTimeout(() => { if (waiting && mine === number) say("running … (the first run of a law compiles it, which takes a while)"); }, 1500);
  setTimeout(() => { if (mine === number && dirty) { waiting = false; send(); } }, 400);
}
function arrived() { waiting = false; if (dirty) send(); }

const acts = {
  form: (found) => { fail(""); form.show(asked, found); by("title").textContent = found.title; by("python").textContent = found.python; answers.expect(found.theorems); },
  ran: (found) => { if (found.status !== "complete") fail(`${found.status}: ${found.message}`); say(`${found.message}; verdicts …`); },
  verdict: (found) => { answers.verdict(found); mark(number, (found.marks || []).map(([t, label]) => ({ t, label }))); },
  poles: (found) => answers.spectrum(found),
  threshold: (found) => form.mark(found),
  cancelled: () => { say("cancelled"); by("cancel").disabled = true; arrived(); },
  error: (found) => { by("cancel").disabled = true; fail(found.text); say("see above"); arrived(); },
  done: () => { by("cancel").disabled = true; if (!said.textContent.startsWith("see")) say("done"); document.body.dataset.done = String(number); arrived(); },
  begun: () => {},
};

let socket = null, tries = 0;
function connect() {
  const token = new URLSearchParams(location.search).get("token");
  socket = new WebSocket(`ws://${location.host}/socket?token=${encodeURIComponent(token)}`);
  socket.binaryType = "arraybuffer";
  socket.onopen = () => { tries = 0; waiting = false; fail(""); send(); };
  socket.onclose = (event) => {
    if (event.code === 4000) { fail(event.reason); return; }
    waiting = false;
    say("no connection to flockana explore: trying again; start it anew if it has ended");
    setTimeout(connect, Math.min(5000, 500 * 1.5 ** tries++));
  };
  socket.onmessage = ({ data }) => {
    if (typeof data === "string") {
      const found = JSON.parse(data);
      if (found.number === number || found.number === -1) acts[found.kind](found);
    } else if (new DataView(data).getUint32(0, true) === number) coming(new Uint8Array(data, 4));
  };
}

let marks = [];  // of verdicts that came before the last frames were shown
function mark(of, found) {
  marks.push(...found);
  if (player && player.of === of && !busy) { player.mark(marks); marks = []; }
}
let newest = null, busy = false;
async function coming(bytes) {  // the newest frames; those that came while others were drawn are left out
  newest = [number, bytes];
  if (busy) return;
  busy = true;
  while (newest) { const [of, data] = newest; newest = null; await show(of, data); }
  busy = false;
  mark(number, []);
}
async function show(of, bytes) {
  while (handles.holding()) await new Promise((go) => setTimeout(go, 30));
  const old = player, before = place.firstElementChild, next = document.createElement("div");
  const focus = before && before.contains(document.activeElement) ? document.activeElement : null;
  next.classList.add("coming");
  place.append(next);
  const made = await flockanaPlayer(next, bytes);
  if (of !== number || !made) { if (made) made.destroy(); next.remove(); return; }
  const { run } = made, last = run.t[run.t.length - 1];
  if (old) { keep(old, made, before, next); old.destroy(); before.remove(); }
  next.classList.remove("coming");
  player = made;
  player.of = of;
  watch(next);
  const time = state.end ? last : Math.min(last, Math.max(run.t[0], state.time === null ? run.t[0] : state.time));
  state.time = time;
  made.show(time);
  if (state.playing && time < last) made.play();
  if (focus) (next.querySelector(`[aria-label="${focus.getAttribute("aria-label")}"]`) || next.querySelector("canvas")).focus();
  by("hint").textContent = run.m === 3
    ? "Drag to turn a run in three dimensions; to place an agent, type its coordinates."
    : "At the start of the run agents, balls, walls and the γ-agent can be dragged; a click on an agent returns to the start.";
  requestAnimationFrame(() => {  // drawn
    if (document.body.dataset.number !== String(of)) document.body.dataset.frames = String(Math.round(performance.now() - since));
    document.body.dataset.number = String(of);
  });
  fresh = false;
  arrived();
}
function keep(old, made, before, next) {  // what the user chose of the picture
  Object.assign(made.drawing.look, { trails: old.drawing.look.trails, velocities: old.drawing.look.velocities, links: old.drawing.look.links });
  const boxes = [...before.querySelectorAll("input[type=checkbox]")];
  next.querySelectorAll("input[type=checkbox]").forEach((box, k) => { if (boxes[k] && boxes[k].checked !== box.checked) box.click(); });
  next.querySelector("select").value = before.querySelector("select").value;
  if (fresh || !state.touched || old.run.m !== made.run.m) return;
  const from = old.drawing, to = made.drawing, origin = [0, 0, 0];
  Object.assign(to.view, { scale: from.view.scale, turn: from.view.turn, tilt: from.view.tilt });
  const [a, b] = from.project(origin, 0), [c, d] = to.project(origin, 0);
  to.view.x += a - c; to.view.y += b - d;
}
function watch(node) {  // the time shown, and whether the view was touched
  const { run } = player, slider = node.querySelector("input[type=range]"), start = node.querySelector("button");
  const last = run.t[run.t.length - 1], one = player;
  const look = () => {
    if (one !== player) return;
    state.time = Number(slider.value) >= 1000 ? last : run.t[0] + (last - run.t[0]) * Number(slider.value) / 1000;
    state.end = Number(slider.value) >= 1000;
    requestAnimationFrame(look);
  };
  requestAnimationFrame(() => requestAnimationFrame(look));
  start.addEventListener("click", () => { state.playing = start.getAttribute("aria-label") === "Pause"; });
  for (const name of ["pointerdown", "wheel", "keydown"]) node.querySelector("canvas").addEventListener(name, () => { state.touched = true; });
  node.querySelectorAll("button").forEach((button) => {
    if (/zoom/i.test(button.getAttribute("aria-label"))) button.addEventListener("click", () => { state.touched = true; });
    if (/^fit/i.test(button.getAttribute("aria-label"))) button.addEventListener("click", () => { state.touched = false; });
  });
}
by("copy").addEventListener("click", async () => {
  await navigator.clipboard.writeText(by("python").textContent).catch(() => getSelection().selectAllChildren(by("python")));
  say("the lines of Python are copied");
});
by("cancel").addEventListener("click", () => socket && socket.send(JSON.stringify({ number, cancel: true, case: asked })));
by("link").addEventListener("click", async () => {
  await navigator.clipboard.writeText(location.href).catch(() => {});
  say("the address of this page, with all its changes, is copied");
});
by("picture").addEventListener("click", () => explorerGive(`${asked.name}.png`, place.querySelector("canvas").toDataURL("image/png"), say));
by("film").addEventListener("click", () => player && explorerFilm(place.querySelector("canvas"), player, 8, say, (film) => explorerGive(`${asked.name}.webm`, film, say)));
by("save").addEventListener("click", async () => {
  say("the run is being written …");
  const token = new URLSearchParams(location.search).get("token");
  const answer = await fetch(`/run?token=${encodeURIComponent(token)}&case=${encodeURIComponent(JSON.stringify(asked))}`);
  if (answer.ok) explorerGive(`${asked.name}.nc`, await answer.blob(), say); else fail(await answer.text());
});
let begin = first;
try { const kept = JSON.parse(decodeURIComponent(location.hash.slice(1))); if (kept && kept.kind) begin = kept; } catch { /* no case in the address */ }
asked = begin;
history_.add({ ...begin });
dirty = true;
form.show(asked, null);
connect();
