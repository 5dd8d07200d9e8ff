// Earlier and later cases, and what the page gives away: its address, a picture, a film, the run.
function explorerHistory(go) {
  const by = (id) => document.getElementById(id), past = [], future = [];
  let now = null, last = 0;
  const show = () => { by("undo").disabled = !past.length; by("redo").disabled = !future.length; by("reset").disabled = !now || (!past.length && !changed(now)); };
  const changed = (one) => Boolean(Object.keys(one.changes || {}).length || Object.keys(one.moved || {}).length || one.duration);

  function add(next) {  // what follows within a moment, as of a slider that is drawn, is one change
    const time = performance.now();
    if (now && JSON.stringify(now) !== JSON.stringify(next)) {
      if (time - last > 600 || !past.length) past.push(now);
      future.length = 0;
      last = time;
    }
    now = next;
    show();
  }
  function step(from, to) {
    if (!from.length) return;
    if (document.activeElement && document.activeElement.matches("input")) document.activeElement.blur();
    to.push(now);
    now = from.pop();
    last = 0;
    show();
    go(now);
  }
  const undo = () => step(past, future), redo = () => step(future, past);
  by("undo").addEventListener("click", undo);
  by("redo").addEventListener("click", redo);
  by("reset").addEventListener("click", () => {
    const { kind, name, seed, n, m } = now, plain = Object.fromEntries(Object.entries({ kind, name, seed, n, m }).filter(([, value]) => value !== undefined));
    last = 0;
    add(plain);
    go(plain);
  });
  document.addEventListener("keydown", (event) => {
    if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
    const key = event.key.toLowerCase(), again = key === "y" || (key === "z" && event.shiftKey);
    if (!again && key !== "z") return;
    event.preventDefault();  // a field's own undoing would leave it apart from the run
    if (again) redo(); else undo();
  });
  return { add };
}
function explorerGive(name, parts, say) {
  const link = document.createElement("a");
  link.download = name;
  link.href = typeof parts === "string" ? parts : URL.createObjectURL(parts);
  link.click();
  if (typeof parts !== "string") setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  say(`${name} is saved`);
}
function explorerFilm(canvas, player, seconds, say, done) {  // the canvas as it plays, recorded by the browser
  if (!canvas.captureStream || !window.MediaRecorder) { say("this browser cannot record a film; use flockana animate"); return; }
  const recorder = new MediaRecorder(canvas.captureStream(30)), pieces = [];
  const { run } = player, first = run.t[0], span = run.t[run.t.length - 1] - first;
  recorder.ondataavailable = ({ data }) => pieces.push(data);
  recorder.onstop = () => done(new Blob(pieces, { type: recorder.mimeType }));
  player.pause();
  recorder.start();
  say("the film is being recorded …");
  const began = performance.now();
  const step = () => {
    const share = Math.min(1, (performance.now() - began) / (1000 * seconds));
    player.show(first + share * span);
    if (share < 1) requestAnimationFrame(step); else recorder.stop();
  };
  step();
}
