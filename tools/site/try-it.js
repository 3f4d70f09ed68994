// The page "Try it": a ball strikes a plate head on, by the closed form that `dentscope export law`
// writes. What goes in is kinetic energy, what comes back is the work of the unloading curve.
"use strict";

// Step of the depth in the integrals; their error is below 1e-5 of what is shown.
const STEP = 1.01;
const ANGLES = 400;

// Work of the loading curve from one depth to a deeper one, by Simpson's rule in ln depth.
function workBetween(force, low, high) {
  const middle = Math.sqrt(low * high);
  const sum = force(low) * low + 4 * force(middle) * middle + force(high) * high;
  return (Math.log(high / low) / 6) * sum;
}

// ball, plate: {E, nu, Sy} in Pa, the ball's density in kg/m3; R in m, speed in m/s.
function upright(law, ball, plate, R, speed) {
  const at = (depth) => law(ball.E, ball.nu, ball.Sy, plate.E, plate.nu, plate.Sy, R, depth);
  const force = (depth) => at(depth).force;
  const mass = (4 / 3) * Math.PI * R ** 3 * ball.density;
  const energy = 0.5 * mass * speed ** 2;
  let depth = 1e-9 * R;
  let work = (force(depth) * depth) / 2.5; // Hertz, before yield
  const loading = [{ depth, force: force(depth), work }];
  while (work < energy && depth < R) {
    work += workBetween(force, depth, STEP * depth);
    depth *= STEP;
    loading.push({ depth, force: force(depth), work });
  }
  if (work < energy) return null; // deeper than the ball's radius
  loading.pop();
  const before = loading[loading.length - 1];
  let [low, high] = [before.depth, depth];
  for (let k = 0; k < 50; k++) {
    const middle = 0.5 * (low + high);
    if (before.work + workBetween(force, before.depth, middle) < energy) low = middle;
    else high = middle;
  }
  const deepest = 0.5 * (low + high);
  const last = at(deepest);
  loading.push({ depth: deepest, force: last.force, work: energy });
  const residual = last.residual_s + last.residual_f;
  const span = deepest - residual;
  const back = (last.force * span) / (last.exponent + 1);
  const restitution = Math.sqrt(back / energy);
  return {
    mass, deepest, residual, restitution, loading,
    exponent: last.exponent,
    force: last.force,
    radius: last.contact_radius,
    pressure: last.force / (Math.PI * last.contact_radius ** 2),
    ballDent: last.residual_s,
    plateDent: last.residual_f,
    time: timeIn(loading, deepest, energy, speed)
      + timeOut(span, last.exponent, restitution * speed),
  };
}

// Time from touch to the deepest point: depth = deepest sin(angle), so that nothing is singular.
function timeIn(loading, deepest, energy, speed) {
  let [time, k] = [0, 0];
  for (let n = 0; n < ANGLES; n++) {
    const angle = ((n + 0.5) * Math.PI) / 2 / ANGLES;
    const depth = deepest * Math.sin(angle);
    while (loading[k + 1].depth < depth) k++;
    const [a, b] = [loading[k], loading[k + 1]];
    const power = Math.log(b.work / a.work) / Math.log(b.depth / a.depth);
    const work = a.work * (depth / a.depth) ** power;
    time += Math.cos(angle) / Math.sqrt(1 - work / energy);
  }
  return (((time * Math.PI) / 2 / ANGLES) * deepest) / speed;
}

function timeOut(span, exponent, speed) {
  let time = 0;
  for (let n = 0; n < ANGLES; n++) {
    const angle = ((n + 0.5) * Math.PI) / 2 / ANGLES;
    time += Math.cos(angle) / Math.sqrt(1 - Math.sin(angle) ** (exponent + 1));
  }
  return (((time * Math.PI) / 2 / ANGLES) * span) / speed;
}

// Where an impact lies outside the pairs and depths that the law was fitted to: a line each.
function outside(limits, ball, plate, R, deepest) {
  const [k_s, k_f] = [ball, plate].map((body) => (1 - body.nu ** 2) / body.E);
  const weaker = Math.min(ball.Sy, plate.Sy);
  const values = [
    ["strength of the ball over that of the plate", "Sy_ratio", ball.Sy / plate.Sy],
    ["E'/Sy of the weaker", "E_reduced_over_Sy_min", 1 / (k_s + k_f) / weaker],
    ["Poisson's ratio of the ball", "nu", ball.nu],
    ["Poisson's ratio of the plate", "nu", plate.nu],
    ["the ball's share of the elastic approach", "elastic_share", k_s / (k_s + k_f)],
    ["depth over radius", "Delta_over_R", deepest / R],
  ];
  return values
    .filter(([, , value]) => Number.isFinite(value) && value > 0)
    .filter(([, key, value]) => value < limits[key][0] || value > limits[key][1])
    .map(([name, key, value]) => {
      const [low, high] = limits[key].map((x) => Number(x.toPrecision(3)));
      return `${name} is ${Number(value.toPrecision(3))}; the law was fitted from ${low} to ${high}`;
    });
}

if (typeof module !== "undefined") module.exports = { upright, outside };

// The form. Its numbers are in the units that stand beside them.
function page() {
  const form = document.getElementById("try-it-form");
  const { metals, limits } = JSON.parse(document.getElementById("try-it-data").textContent);
  const field = (name) => form.elements.namedItem(name);
  const filled = (body) => {
    const metal = metals[field(`${body}-metal`).value];
    if (!metal) return;
    field(`${body}-E`).value = metal.E / 1e9;
    field(`${body}-nu`).value = metal.nu;
    field(`${body}-Sy`).value = metal.Sy === null ? "" : metal.Sy / 1e6;
    if (body === "ball") field("ball-density").value = metal.density;
  };
  const body = (name) => ({
    E: field(`${name}-E`).valueAsNumber * 1e9,
    nu: field(`${name}-nu`).valueAsNumber,
    Sy: field(`${name}-Sy`).value === "" ? Infinity : field(`${name}-Sy`).valueAsNumber * 1e6,
    density: name === "ball" ? field("ball-density").valueAsNumber : NaN,
  });
  for (const select of form.querySelectorAll("select")) {
    for (const [name, metal] of Object.entries(metals)) {
      select.add(new Option(metal.title, name, false, name === select.dataset.first));
    }
    select.add(new Option("numbers of your own", "", false, false));
    select.addEventListener("change", () => filled(select.name.split("-")[0]));
  }
  form.addEventListener("input", (event) => {
    const own = /^(ball|plate)-(E|nu|Sy|density)$/.exec(event.target.name);
    if (own) field(`${own[1]}-metal`).value = "";
    update();
  });
  form.addEventListener("submit", (event) => event.preventDefault());

  function update() {
    const said = document.getElementById("try-it-said");
    const wrong = [...form.querySelectorAll("input")].find((input) => !input.validity.valid);
    if (wrong) {
      said.textContent = `${wrong.labels[0].textContent}: from ${wrong.min} to ${wrong.max}`;
      return;
    }
    const R = field("radius").valueAsNumber / 1e3;
    const speed = field("speed").valueAsNumber;
    const [ball, plate] = [body("ball"), body("plate")];
    const found = upright(dentscope_contact, ball, plate, R, speed);
    if (!found) {
      said.textContent = "The ball goes in by more than its radius: no contact law holds there.";
      return;
    }
    said.textContent = outside(limits, ball, plate, R, found.deepest).join(". ");
    const shown = {
      restitution: found.restitution,
      "plate-dent": found.plateDent * 1e6,
      "ball-dent": found.ballDent * 1e6,
      width: 2e3 * found.radius,
      force: found.force / 1e3,
      pressure: found.pressure / 1e6,
      time: found.time * 1e3,
    };
    for (const [name, value] of Object.entries(shown)) {
      document.getElementById(`try-it-${name}`).textContent = Number(value.toPrecision(4)).toString();
    }
    const back = Array.from({ length: 101 }, (_, k) => {
      const share = 1 - k / 100;
      const depth = found.residual + share * (found.deepest - found.residual);
      return [depth * 1e6, (found.force * share ** found.exponent) / 1e3];
    });
    const path = found.loading.map((row) => [row.depth * 1e6, row.force / 1e3]).concat(back);
    drawn("try-it-loop", path, { x: "approach [um]", y: "force [kN]" });
    const speeds = Array.from({ length: 41 }, (_, k) => speed * 10 ** (k / 20 - 1.5));
    const curve = speeds
      .map((v) => [v, upright(dentscope_contact, ball, plate, R, v)])
      .filter(([, one]) => one !== null && one.deepest / R <= limits.Delta_over_R[1])
      .map(([v, one]) => [Math.log10(v), one.restitution]);
    drawn("try-it-curve", curve, {
      x: "speed [m/s]", y: "restitution", logarithmic: true, least: 0, most: 1,
      mark: [Math.log10(speed), found.restitution],
    });
  }
  for (const name of ["ball", "plate"]) filled(name);
  update();
}

// A line in a frame with ticks, as SVG in the page's own colours.
function drawn(id, points, { x, y, logarithmic = false, least = null, most = null, mark = null }) {
  const [wide, high, left, below, above] = [360, 250, 52, 42, 12];
  const svg = document.getElementById(id);
  const range = (values) => [Math.min(...values), Math.max(...values)];
  const [x0, x1] = range(points.map((p) => p[0]));
  const [lowest, highest] = range(points.map((p) => p[1]));
  const [y0, y1] = [least ?? lowest, most ?? highest];
  const px = (v) => left + ((v - x0) / (x1 - x0 || 1)) * (wide - left - 12);
  const py = (v) => high - below - ((v - y0) / (y1 - y0 || 1)) * (high - below - above);
  const parts = [`<rect x="${left}" y="${above}" width="${wide - left - 12}" `
    + `height="${high - below - above}" class="frame"/>`];
  for (const v of logarithmic ? decades(x0, x1) : ticks(x0, x1)) {
    const text = logarithmic ? Number((10 ** v).toPrecision(1)) : v;
    parts.push(`<path d="M${px(v)} ${high - below}v5" class="frame"/>`
      + `<text x="${px(v)}" y="${high - below + 18}" text-anchor="middle">${text}</text>`);
  }
  for (const v of ticks(y0, y1)) {
    parts.push(`<path d="M${left} ${py(v)}h-5" class="frame"/>`
      + `<text x="${left - 8}" y="${py(v) + 4}" text-anchor="end">${v}</text>`);
  }
  parts.push(`<text x="${(left + wide) / 2}" y="${high - 6}" text-anchor="middle">${x}</text>`,
    `<text transform="translate(12 ${(high - below) / 2}) rotate(-90)" text-anchor="middle">${y}</text>`,
    `<path d="M${points.map((p) => `${px(p[0]).toFixed(1)} ${py(p[1]).toFixed(1)}`).join("L")}" class="line"/>`);
  if (mark) parts.push(`<circle cx="${px(mark[0])}" cy="${py(mark[1])}" r="4.5" class="mark"/>`);
  svg.setAttribute("viewBox", `0 0 ${wide} ${high}`);
  svg.innerHTML = parts.join("");
}

// Round numbers, some five of them, within a range.
function ticks(low, high) {
  const rough = (high - low || 1) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= rough);
  const found = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) {
    found.push(Number((k * step).toPrecision(6)));
  }
  return found;
}

function decades(low, high) {
  const found = [];
  for (let k = Math.floor(low); k <= high; k++) {
    for (const m of [1, 2, 5]) {
      const at = k + Math.log10(m);
      if (at >= low - 1e-9 && at <= high + 1e-9) found.push(at);
    }
  }
  return found.length > 5 ? found.filter((at) => Math.abs(at - Math.round(at)) < 1e-9) : found;
}

if (typeof document !== "undefined") window.addEventListener("load", page);
