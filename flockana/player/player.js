// The player: a drawing, its strip, and the controls of both. Returns a promise of { show, play, pause, mark, destroy, run }.
async function flockanaPlayer(place, bytes) {
  place.classList.add("flockana-player");
  let run;
  try {
    run = await decodeRun(bytes);
  } catch (error) {
    place.textContent = `This run cannot be shown here: ${error.message}.`;
    return null;
  }
  const first = run.t[0], last = run.t[run.t.length - 1], span = last - first || 1;
  const add = (kind, words, parent, attributes = {}) => {
    const node = document.createElement(kind);
    if (words) node.textContent = words;
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    parent.append(node);
    return node;
  };
  place.replaceChildren();
  place.setAttribute("role", "group");
  place.setAttribute("aria-label", `Player: ${run.title}`);
  const canvas = add("canvas", "", place, { tabindex: "0", role: "img" });
  const bar = add("div", "", place, { class: "fp-bar" });
  const button = (words, name, act) => {
    const node = add("button", words, bar, { type: "button", "aria-label": name, title: name });
    node.addEventListener("click", act);
    return node;
  };
  const start = button("▶", "Play", () => toggle());
  const slider = add("input", "", bar, { type: "range", min: 0, max: 1000, step: "any", value: 0, "aria-label": "Time" });
  const clock = add("span", "", bar, { class: "fp-clock" });
  const speed = add("select", "", bar, { "aria-label": "Speed" });
  for (const factor of [0.1, 0.25, 0.5, 1, 2, 4]) add("option", `${factor}×`, speed, { value: factor });
  speed.value = "1";
  button("+", "Zoom in", () => zoom(1.25));
  button("−", "Zoom out", () => zoom(0.8));
  button("fit", "Fit the whole run", () => { drawing.fit(); redraw(); });
  for (const name of ["trails", "velocities", "links", "follow"]) {
    const label = add("label", "", bar), box = add("input", "", label, { type: "checkbox" });
    label.append(` ${name}`);
    box.checked = name !== "follow";
    box.addEventListener("change", () => {
      if (name === "follow") drawing.follow(box.checked); else drawing.look[name] = box.checked;
      redraw();
    });
  }
  const strip = flockanaStrip(add("div", "", place, { class: "fp-strip" }), run, (t) => { pause(); show(t); });
  const said = add("p", "", place, { class: "fp-hidden", "aria-live": "polite" });
  const drawing = flockanaDrawing(canvas, run);
  const player = { show, play, pause, mark: strip.mark, destroy, run, drawing, frames: 0, onpause: null };
  let time = first, playing = false, before = 0, asked = 0;

  function redraw() { if (!asked) asked = requestAnimationFrame(step); }
  function step(now) {
    asked = 0;
    if (playing) {
      time += Math.min(0.1, (now - before) / 1000) * Number(speed.value) * span / 12;  // a run lasts 12 seconds
      before = now;
      if (time >= last) { time = last; pause(); } else redraw();
    }
    drawing.draw(time);
    strip.show(time);
    player.frames++;
    slider.value = String(1000 * (time - first) / span);
    clock.textContent = `t = ${Number(time.toPrecision(4))}`;
    slider.setAttribute("aria-valuetext", clock.textContent);
  }
  function show(t) { time = Math.min(last, Math.max(first, t)); redraw(); if (!playing) tell(); }
  function tell() {
    said.textContent = `t = ${Number(time.toPrecision(4))}; ${strip.words(time)}`;
    canvas.setAttribute("aria-label", `${run.title}, ${said.textContent}`);
    if (player.onpause) player.onpause(time);
  }
  function play() {
    if (time >= last) time = first;
    playing = true; before = performance.now();
    start.textContent = "❚❚"; start.setAttribute("aria-label", "Pause"); start.title = "Pause";
    redraw();
  }
  function pause() {
    if (!playing) return;
    playing = false;
    start.textContent = "▶"; start.setAttribute("aria-label", "Play"); start.title = "Play";
    tell();
  }
  function toggle() { if (playing) pause(); else play(); }
  function zoom(factor, x = canvas.clientWidth / 2, y = canvas.clientHeight / 2) {
    const { view } = drawing, u = x - canvas.clientWidth / 2, v = y - canvas.clientHeight / 2;
    view.scale *= factor; view.x = u + factor * (view.x - u); view.y = v + factor * (view.y - v);
    redraw();
  }
  function move(x, y, turns) {
    const { view } = drawing;
    if (turns) { view.turn -= 0.01 * x; view.tilt = Math.min(1.57, Math.max(-1.57, view.tilt + 0.01 * y)); } else { view.x += x; view.y += y; }
    redraw();
  }
  slider.addEventListener("input", () => { pause(); show(first + span * Number(slider.value) / 1000); });
  let held = null;
  canvas.addEventListener("pointerdown", (event) => { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); });
  canvas.addEventListener("pointermove", (event) => {
    if (!held) return;
    move(event.clientX - held[0], event.clientY - held[1], run.m === 3 && !event.shiftKey);
    held = [event.clientX, event.clientY];
  });
  for (const name of ["pointerup", "pointercancel"]) canvas.addEventListener(name, () => { held = null; });
  canvas.addEventListener("wheel", (event) => {
    if (!event.ctrlKey && document.activeElement !== canvas) return;  // else the page scrolls
    event.preventDefault();
    zoom(Math.exp(-0.002 * event.deltaY), event.offsetX, event.offsetY);
  }, { passive: false });
  canvas.addEventListener("keydown", (event) => {
    const hop = span / 100, far = 30;
    const acts = {
      " ": toggle, ArrowLeft: () => { pause(); show(time - hop); }, ArrowRight: () => { pause(); show(time + hop); },
      Home: () => show(first), End: () => show(last), "+": () => zoom(1.25), "=": () => zoom(1.25), "-": () => zoom(0.8),
      "0": () => { drawing.fit(); redraw(); },
    };
    const pans = { ArrowLeft: [-far, 0], ArrowRight: [far, 0], ArrowUp: [0, -far], ArrowDown: [0, far] };
    const act = event.shiftKey && pans[event.key] ? () => move(...pans[event.key], run.m === 3) : acts[event.key];
    if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    act();
  });
  const dark = matchMedia("(prefers-color-scheme: dark)"), recolour = () => { drawing.palette(); redraw(); };
  dark.addEventListener("change", recolour);
  const sizes = new ResizeObserver(() => { drawing.resize(); redraw(); });
  sizes.observe(canvas);
  function destroy() {
    playing = false; sizes.disconnect(); dark.removeEventListener("change", recolour); cancelAnimationFrame(asked);
    place.replaceChildren();
  }
  drawing.palette(); drawing.resize(); drawing.fit(); show(first);
  return player;
}
