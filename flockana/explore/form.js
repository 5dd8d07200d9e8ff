// What can be changed: the start, the law's numbers with sliders, one agent's place.
const DECADES = 1.5, RATIOS = [-3, 2];

function explorerForm(place, groups, ask) {
  let current = null, latest = null, threshold = null;
  const make = (kind, words, parent, attributes = {}) => {
    const node = document.createElement(kind);
    if (words) node.textContent = words;
    for (const [name, value] of Object.entries(attributes)) node.setAttribute(name, value);
    parent.append(node);
    return node;
  };
  const short = (value) => String(Number(Number(value).toPrecision(6)));
  const symbols = { alpha: "α", beta: "β", gamma: "γ", eps: "ε", eta: "η", delta: "δ", kappa: "κ" };
  const named = (path) => path.split(".").slice(path.includes(".") ? 1 : 0).join(" ").replace(/_?(alpha|beta|gamma|eps|eta|delta|kappa)\b/g, (_, name) => symbols[name]);
  const finite = (node) => {
    const good = node.value.trim() !== "" && Number.isFinite(Number(node.value));
    node.setAttribute("aria-invalid", String(!good));
    return good;
  };

  const start = make("fieldset", "", place), numbers = make("div", "", place), agents = make("fieldset", "", place);
  make("legend", "Start", start);
  const chosen = make("select", "", make("div", "", start, { class: "field wide" }), { "aria-label": "Scenario or law", id: "start" });
  for (const { label, kind, names } of groups) {
    const group = make("optgroup", "", chosen, { label });
    for (const [name, title] of Object.entries(names)) make("option", title ? `${name}: ${title}` : name, group, { value: `${kind}:${name}` });
  }
  chosen.addEventListener("change", () => {
    const [kind, name] = [chosen.value.slice(0, chosen.value.indexOf(":")), chosen.value.slice(chosen.value.indexOf(":") + 1)];
    ask({ kind, name, seed: 0 }, true);
  });
  const whole = (name, label, least, most) => {
    const row = make("div", "", start, { class: "field" });
    make("label", label, row, { for: `start-${name}` });
    const input = make("input", "", row, { type: "number", id: `start-${name}`, min: least, max: most, step: name === "duration" ? "any" : 1 });
    input.addEventListener("change", () => { if (finite(input)) ask({ ...current, [name]: Number(input.value), moved: name === "duration" ? current.moved : {} }, name !== "duration"); });
    return input;
  };
  const fields = { seed: whole("seed", "seed", 0, 1e9), n: whole("n", "agents", 1, 3000), m: whole("m", "dimensions", 1, 3), duration: whole("duration", "duration", 0, 1e9) };

  make("legend", "Place of an agent at the start", agents);
  const row = make("div", "", agents, { class: "vector" });
  const agent = make("input", "", row, { type: "number", min: 0, step: 1, value: 0, "aria-label": "Number of the agent" });
  const axes = ["x", "y", "z"].map((name) => make("input", "", row, { type: "number", step: "any", "aria-label": `${name} of the agent` }));
  const where = () => latest.q0[Number(agent.value)] || [];
  const fill = () => axes.forEach((node, c) => { node.hidden = c >= latest.m; node.value = c < latest.m && where().length ? short(where()[c]) : ""; });
  agent.addEventListener("input", fill);
  axes.forEach((node) => node.addEventListener("change", () => {
    const given = axes.slice(0, latest.m);
    if (where().length && given.map(finite).every(Boolean)) move(Number(agent.value), given.map((each) => Number(each.value)));
  }));
  function move(number, point) { ask({ ...current, moved: { ...current.moved, [number]: point } }); }
  function change(path, value) {
    const changes = { ...current.changes, [path]: value }, { usual } = latest.numbers.find((each) => each.path === path);
    if (String(usual) === String(value)) delete changes[path];
    ask({ ...current, changes });
  }

  function slider(parent, label, value, low, high, logarithmic, act) {
    const from = (x) => (logarithmic ? Math.log10(Math.max(x, 1e-300)) : x), to = (x) => (logarithmic ? 10 ** x : x);
    const node = make("input", "", parent, { type: "range", min: from(low), max: from(high), step: "any", "aria-label": `${label}, slider` });
    node.value = String(from(value));
    const say = () => node.setAttribute("aria-valuetext", short(to(Number(node.value))));
    say();
    node.addEventListener("input", () => { say(); act(Number(to(Number(node.value)).toPrecision(4))); });
    return node;
  }
  function scalar(parent, { path, value, usual }) {
    const label = named(path), id = `number-${path}`;
    const row = make("div", "", parent, { class: `field${value !== usual ? " changed" : ""}` });
    make("label", label, row, { for: id });
    if (typeof value === "boolean") {
      const box = make("input", "", row, { type: "checkbox", id });
      box.checked = value;
      box.addEventListener("change", () => change(path, box.checked));
      return { path, set: (now) => { box.checked = now; } };
    }
    const input = make("input", "", row, { type: "number", step: "any", id });
    input.value = short(value);
    input.addEventListener("change", () => { if (finite(input)) change(path, Number(input.value)); });
    const positive = usual > 0, far = Math.max(1, 3 * Math.abs(usual));
    const [low, high] = positive ? [usual * 10 ** -DECADES, usual * 10 ** DECADES] : [-far, far];
    const range = slider(row, path, value, low, high, positive, (now) => { input.value = short(now); change(path, now); });
    return { path, set: (now) => { row.classList.toggle("changed", now !== usual); if (document.activeElement !== input) input.value = short(now);
      if (document.activeElement !== range) range.value = String(positive ? Math.log10(Math.max(now, 1e-300)) : now); } };
  }
  function vector(parent, { path, value, usual }) {
    const row = make("div", "", parent, { class: `field${String(value) !== String(usual) ? " changed" : ""}` });
    make("label", named(path), row, { for: `number-${path}-0` });
    const parts = make("div", "", row, { class: "vector" });
    const inputs = value.map((v, c) => {
      const node = make("input", "", parts, { type: "number", step: "any", id: `number-${path}-${c}`, "aria-label": `${path}, component ${c + 1}` });
      node.value = short(v);
      node.addEventListener("change", () => { if (inputs.map(finite).every(Boolean)) change(path, inputs.map((each) => Number(each.value))); });
      return node;
    });
    return { path, set: (now) => inputs.forEach((node, c) => { if (document.activeElement !== node) node.value = short(now[c]); }) };
  }
  let shown = [], signature = "", ratio = null;
  function squeeze(parent) {  // c1γ/c1α on a logarithmic scale, with the threshold of collapse
    const box = make("fieldset", "", parent), value = () => of("gains.c1_gamma") / of("gains.c1_alpha");
    make("legend", "c1γ/c1α: pull over repulsion", box);
    const row = make("div", "", box, { class: "field" });
    make("span", "logarithmic", row, { class: "muted" });
    const output = make("output", short(value()), row);
    const range = slider(row, "c1γ/c1α", Math.max(value(), 10 ** RATIOS[0]), 10 ** RATIOS[0], 10 ** RATIOS[1], true, (now) => {
      output.textContent = short(now);
      change("gains.c1_gamma", Number((now * of("gains.c1_alpha")).toPrecision(4)));
    });
    const mark = make("div", "", row, { class: "mark" });
    ratio = { set: () => { output.textContent = short(value()); if (document.activeElement !== range) range.value = String(Math.log10(Math.max(value(), 1e-9))); },
      tell: () => {
        mark.replaceChildren();
        if (!threshold) { make("span", "threshold of collapse: being computed", mark); return; }
        if (threshold.note) { make("span", threshold.note, mark); return; }
        const share = (Math.log10(threshold.high) - RATIOS[0]) / (RATIOS[1] - RATIOS[0]);
        make("i", "", mark).style.left = `calc(${100 * share}% + ${8 - 16 * share}px)`;
        make("span", `agents coincide from ${short(threshold.low.toPrecision(3))} … ${short(threshold.high.toPrecision(3))} on (E11)`, mark);
      } };
    ratio.tell();
  }
  const of = (path) => latest.numbers.find((each) => each.path === path).value;

  function show(asked, form) {
    current = { changes: {}, moved: {}, ...asked };
    if (!form) return;
    latest = form;
    chosen.value = `${current.kind}:${current.name}`;
    for (const [name, input] of Object.entries(fields)) {
      input.parentElement.hidden = (name !== "duration" && current.kind === "file") || ((name === "n" || name === "m") && current.kind !== "law");
      if (document.activeElement !== input) input.value = short({ seed: current.seed || 0, n: form.n, m: form.m, duration: form.duration }[name]);
    }
    agent.max = String(form.n - 1);
    fill();
    const now = JSON.stringify([form.law, form.ratio, form.numbers.map(({ path, usual }) => [path, usual])]);
    if (now !== signature) { signature = now; threshold = null; build(); } else shown.forEach((each) => each.set(of(each.path)));
    if (ratio) ratio.set();
  }
  function build() {
    numbers.replaceChildren(); shown = []; ratio = null;
    if (latest.ratio) squeeze(numbers);
    const groups = Map.groupBy ? Map.groupBy(latest.numbers, ({ path }) => path.split(".")[0]) : grouped();
    for (const [name, list] of groups) {
      const group = make("details", "", numbers);
      group.open = ["gains", "alpha", "interaction", "obstacles", "target", "weight", "law"].includes(name);
      make("summary", name, group);
      for (const each of list) shown.push(Array.isArray(each.value) ? vector(group, each) : scalar(group, each));
    }
  }
  function grouped() {
    const groups = new Map();
    for (const each of latest.numbers) { const name = each.path.split(".")[0]; groups.set(name, [...(groups.get(name) || []), each]); }
    return groups;
  }
  place.addEventListener("submit", (event) => event.preventDefault());
  return { show, move, change, form: () => latest, case: () => current, mark: (found) => { threshold = found; if (ratio) ratio.tell(); } };
}
