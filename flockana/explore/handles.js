// Agents, balls, walls and the γ-agent as things to take hold of, on the player's canvas at the start of a run.
function explorerHandles(place, player, form, taken, rewound) {
  const close = (event) => (event.pointerType === "touch" ? 20 : 10);

  function axes({ drawing, run }) {  // pixels are an affine function of places: origin and inverse of its matrix
    const at = (x, y) => drawing.project([x, y, 0].slice(0, Math.max(run.m, 1)), 0);
    const [ox, oy] = at(0, 0), [ax, ay] = at(1, 0), scale = ax - ox;
    return { place: (dx, dy) => (run.m === 1 ? [dx / scale] : [dx / scale, -dy / scale]), scale, ay };
  }
  function found(event) {
    const now = player();
    if (!now || now.run.m > 2 || !now.drawing.project) return null;
    if (now.time() !== now.run.t[0]) return null;
    const { run, drawing } = now, { m } = run, canvas = place.querySelector("canvas");
    const box = canvas.getBoundingClientRect(), u = event.clientX - box.left - canvas.clientLeft, v = event.clientY - box.top - canvas.clientTop;
    const far = (values, i) => { const [x, y] = drawing.project(values, i); return Math.hypot(x - u, y - v); };
    let best = null, least = close(event);
    for (let i = 0; i < run.n; i++) {
      const distance = far(run.q, i * m);
      if (distance <= least) { least = distance; best = { agent: i, moved: [[run.q, i * m]] }; }
    }
    const places = form.form().numbers.filter((each) => each.place);
    if (!best && run.stars && far(run.stars, 0) <= close(event) + 4) {
      const target = places.find(({ path }) => /(^|\.)target\.(q|start|centre)$/.test(path));
      if (target) best = { ...target, moved: [[run.stars, 0]] };
    }
    if (!best) run.solids.forEach(({ kind, par }, k) => {
      const own = places.find(({ path }) => new RegExp(`(^|\\.)obstacles\\.${k}\\.(centre|point)$`).test(path));
      const [x, y] = kind === "other" ? [] : drawing.project(par, 0);
      const off = kind === "sphere" ? Math.hypot(x - u, y - v) - par[m] * axes(now).scale : kind === "wall" ? (u - x) * par[m] - (v - y) * (par[m + 1] || 0) : 1;
      if (own && off <= 0) best = { ...own, moved: [[par, 0]] };
    });
    return best && { ...best, now, x: event.clientX, y: event.clientY, from: best.moved.map(([values, i]) => Array.from(values.slice(i, i + m))) };
  }

  function near(event, { run, drawing, time }) {  // whether an agent, where it is now, is under the pointer
    const canvas = place.querySelector("canvas"), box = canvas.getBoundingClientRect();
    const u = event.clientX - box.left - canvas.clientLeft, v = event.clientY - box.top - canvas.clientTop;
    let k = 0;
    while (k + 1 < run.t.length && run.t[k + 1] <= time()) k++;
    for (let i = 0; i < run.n; i++) {
      const [x, y] = drawing.project(run.q, (k * run.n + i) * run.m);
      if (Math.hypot(x - u, y - v) <= close(event)) return true;
    }
    return false;
  }
  let held = null;
  place.addEventListener("pointerdown", (event) => {
    if (event.target.tagName !== "CANVAS" || event.button) return;
    const now = player();
    if (now && now.run.m < 3 && now.time() !== now.run.t[0] && near(event, now)) {
      event.preventDefault(); event.stopPropagation();
      now.pause();
      rewound();
      return;
    }
    held = found(event);
    if (!held) return;
    event.preventDefault(); event.stopPropagation();  // or the player would move its view
    event.target.setPointerCapture(event.pointerId);
    held.now.pause();
    taken();
  }, true);
  const by = (event) => axes(held.now).place(event.clientX - held.x, event.clientY - held.y);
  place.addEventListener("pointermove", (event) => {
    if (!held) {
      const canvas = place.querySelector("canvas");
      if (event.target === canvas && !event.buttons) canvas.style.cursor = found(event) ? "move" : "";
      return;
    }
    event.stopPropagation();
    const step = by(event);
    held.moved.forEach(([values, i], k) => step.forEach((d, c) => { values[i + c] = held.from[k][c] + d; }));
    held.now.show(held.now.run.t[0]);
  }, true);
  const let_go = (event) => {
    if (!held) return;
    const step = by(event), rounded = (x) => Number(x.toPrecision(6)), { agent, path, value } = held;
    const still = Math.hypot(event.clientX - held.x, event.clientY - held.y) < 2;
    held = null;
    if (still || event.type === "pointercancel") return;
    if (path) form.change(path, value.map((v, c) => rounded(v + step[c])));
    else form.move(agent, form.form().q0[agent].map((v, c) => rounded(v + step[c])));
  };
  for (const name of ["pointerup", "pointercancel"]) place.addEventListener(name, let_go, true);
  return { holding: () => held !== null };
}
