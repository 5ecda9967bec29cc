"use strict";

/* One viewer of gaits. `root` is the section of viewer.html, `gaits` are the payloads of
   payload.py, perhaps with one of human.py behind them. Gaits are laid over each other at the same
   fraction of their strides; `position` counts strides from the beginning of the film. Returns a
   function that ends the viewer, for a page that shows other gaits later. */
function ergowalkViewer(root, gaits) {
  const find = (name) => root.querySelector("." + name);
  const play = find("play"), speed = find("speed"), strides = find("strides");
  const scrub = find("scrub"), clock = find("clock");
  const shown = gaits.map(() => true);
  const end = new AbortController(), untilEnd = { signal: end.signal };
  gaits.forEach((gait, i) => (gait.key = gait.kind === "human" ? "human" : String(i % 6)));
  let position = 0, playing = false, last = 0, told = 0, stale = true;

  const stage = new WalkStage(find("stage"), root, gaits);
  const bars = new PhaseBars(find("phases"), gaits);
  const curves = new CurveGrid(find("curves"), gaits);
  addLegend();
  fillKeys();

  const count = () => Number(strides.value);
  const visible = () => gaits.map((_, i) => i).filter((i) => shown[i]);
  const leader = () => gaits[visible()[0] ?? 0];

  function draw() {
    const stride = Math.min(Math.floor(position), count() - 1);
    const fraction = position - stride;
    stage.draw(visible(), stride, fraction);
    bars.point(fraction);
    curves.point(fraction);
    scrub.value = position;
    root.dataset.position = position.toFixed(4);
    if (!playing || last - told > TELL_EVERY) {
      told = last;
      tell(stride, fraction);
    }
  }

  function tell(stride, fraction) {
    curves.tell(fraction);
    const time = (position * leader().stride_time).toFixed(2);
    const text = `${time} s, stride ${stride + 1}, ${Math.round(100 * fraction)} %`;
    clock.textContent = text;
    scrub.setAttribute("aria-valuetext", text);
  }

  function seek(target) {
    position = Math.max(0, Math.min(count(), target));
    stale = true;
  }

  function setPlaying(on) {
    playing = on;
    stale = true;
    play.textContent = on ? "❚❚ Pause" : "▶ Play";
    play.setAttribute("aria-label", on ? "Pause" : "Play");
  }

  function onFrame(now) {
    if (end.signal.aborted) return;
    const passed = Math.min((now - last) / 1000, 0.1); // a tab that was hidden goes on where it was
    last = now;
    if (playing) {
      position = (position + (passed * Number(speed.value)) / leader().stride_time) % count();
      stale = true;
    }
    if (stale) {
      stale = false;
      draw();
    }
    requestAnimationFrame(onFrame);
  }

  function setVisible() {
    bars.show(visible());
    curves.show(visible());
    stale = true;
  }

  function addLegend() {
    gaits.forEach((gait, i) => {
      const label = document.createElement("label"), box = document.createElement("input");
      box.type = "checkbox";
      box.checked = true;
      box.addEventListener("change", () => {
        shown[i] = box.checked;
        setVisible();
      });
      const name = document.createElement("span");
      name.textContent = " " + gait.label;
      label.append(box, " ", lineSample(gait.key), name);
      if (!gait.acceptable) {
        const mark = document.createElement("span");
        mark.className = "refused";
        mark.textContent = " (not acceptable)";
        label.append(mark);
      }
      find("gaits").append(label);
    });
  }

  function fillKeys() {
    find("low").textContent = "−" + stage.strongest.toFixed(1);
    find("high").textContent = "+" + stage.strongest.toFixed(1) + " W/kg";
    find("human").textContent = gaits[0].human;
  }

  function resize() {
    stage.resize();
    stale = true;
  }

  play.addEventListener("click", () => setPlaying(!playing));
  scrub.addEventListener("input", () => {
    setPlaying(false);
    seek(Number(scrub.value));
  });
  strides.addEventListener("change", () => {
    scrub.max = count();
    seek(position % count());
  });
  document.addEventListener("keydown", (event) => {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    if (event.target.closest("button, input, select, textarea, summary, .scrolls")) return;
    const step = event.shiftKey ? 0.1 : 0.01;
    if (event.key === " ") setPlaying(!playing);
    else if (event.key === "ArrowRight") setPlaying(false), seek(position + step);
    else if (event.key === "ArrowLeft") setPlaying(false), seek(position - step);
    else return;
    event.preventDefault();
  }, untilEnd);
  onDrag(find("stage"), (event, from) => {
    setPlaying(false);
    seek(from.position + (event.clientX - from.x) / from.width);
  }, () => position);
  for (const plot of curves.plots) {
    onDrag(plot, (event, from) => {
      const fraction = (event.clientX - from.left) / from.width;
      setPlaying(false);
      seek(Math.min(Math.floor(position), count() - 1) + Math.max(0, Math.min(1, fraction)));
    }, () => position);
  }
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", resize, untilEnd);
  const sizes = new ResizeObserver(resize);
  sizes.observe(find("stage"));

  scrub.max = count();
  setVisible();
  resize();
  setPlaying(!matchMedia("(prefers-reduced-motion: reduce)").matches);
  requestAnimationFrame((now) => {
    last = now;
    onFrame(now);
  });
  return () => {
    end.abort();
    sizes.disconnect();
  };
}

/* Call `moved` while a pointer, mouse or finger, is held down on an element. */
function onDrag(element, moved, position) {
  let from = null;
  element.addEventListener("pointerdown", (event) => {
    const box = element.getBoundingClientRect();
    from = { x: event.clientX, left: box.left, width: box.width, position: position() };
    element.setPointerCapture(event.pointerId);
    moved(event, from);
  });
  element.addEventListener("pointermove", (event) => from && moved(event, from));
  for (const end of ["pointerup", "pointercancel"]) {
    element.addEventListener(end, () => (from = null));
  }
}

/* The walker's looks; lengths in metres. A limb is as thick as two radii at its ends say. Films take
   these from here: it must stay JSON. */
const LOOKS = {
  "per_weight": 0.6,
  "below": 0.17,
  "above": 0.06,
  "head": { "radius": 0.1, "above": 0.21 },
  "limbs": {
    "neck": [0.05, 0.045], "trunk": [0.085, 0.105],
    "thigh": [0.08, 0.055], "shank": [0.055, 0.036], "toes": [0.022, 0.012]
  },
  "foot_edge": 0.045,
  "hips_apart": 0.035,
  "joint": { "least": 0.02, "more": 0.03 },
  "arrow_head": { "length": 0.07, "turn": 0.4 },
  "shares": { "trunk": 0.7, "far_leg": 0.45, "far_line": 0.6 }
};

const TELL_EVERY = 150; // ms between new figures in a running film: nobody reads faster
const DASHES = { 0: "", 1: "7 3", 2: "2 2", 3: "9 3 2 3", 4: "4 4", 5: "1 3", human: "4 3" };
const gaitColour = (key) => `var(--gait-${key})`;

/* The line of a gait as the legend shows it. */
function lineSample(key) {
  const sample = document.createElement("span");
  sample.innerHTML =
    `<svg class="line" width="34" height="8" aria-hidden="true"><line x1="0" x2="34" y1="4" y2="4"
     stroke="${gaitColour(key)}" stroke-width="4" stroke-dasharray="${DASHES[key]}"/></svg>`;
  return sample;
}

/* A colour of which `share` is the first and the rest the second, both as #rrggbb. */
function mixed(first, second, share) {
  const parts = (colour) => [1, 3, 5].map((i) => parseInt(colour.slice(i, i + 2), 16));
  const b = parts(second);
  return `rgb(${parts(first).map((v, i) => Math.round(share * v + (1 - share) * b[i])).join(",")})`;
}

/* A value between two frames; rows may be numbers or lists of them. Null where one is missing. */
function between(rows, fraction) {
  const place = fraction * (rows.length - 1), i = Math.min(Math.floor(place), rows.length - 2);
  const mix = (a, b) => (a === null || b === null ? null : a + (place - i) * (b - a));
  const a = rows[i], b = rows[i + 1];
  return Array.isArray(a) ? a.map((v, k) => mix(v, b[k])) : mix(a, b);
}

/* How far the hip is ahead of a point that goes at the mean speed, in the mean of the stride. */
function ahead(gait) {
  const last = gait.hip.length - 1, way = gait.stride_length;
  const off = gait.hip.slice(0, last).map((p, i) => p[0] - (i / last) * way);
  return off.reduce((sum, v) => sum + v, 0) / last;
}

/* The picture of the walkers on a canvas. Lengths in metres until they reach the screen. */
class WalkStage {
  constructor(canvas, root, gaits) {
    this.canvas = canvas;
    this.root = root;
    this.gaits = gaits;
    this.ahead = new Map(gaits.map((gait) => [gait, ahead(gait)]));
    this.pen = canvas.getContext("2d");
    const tops = gaits.flatMap((g) => g.trunk_top.map((p) => p[1]));
    this.height = Math.max(...tops) + LOOKS.head.above + LOOKS.head.radius + LOOKS.above;
    const powers = gaits.flatMap((g) => g.legs.flatMap((leg) => leg.power.flat()));
    this.strongest = powers.reduce((most, p) => Math.max(most, Math.abs(p)), 0.1);
  }

  resize() {
    const box = this.canvas.getBoundingClientRect(), ratio = window.devicePixelRatio || 1;
    this.canvas.width = Math.round(box.width * ratio);
    this.canvas.height = Math.round(box.height * ratio);
    const style = getComputedStyle(this.root);
    const known = {}; // asking for a style while the page changes is slow
    this.colour = (name) => (known[name] ??= style.getPropertyValue("--" + name).trim());
    this.scale = this.canvas.height / (this.height + LOOKS.below);
    this.pixel = ratio / this.scale;
  }

  draw(visible, stride, fraction) {
    const pen = this.pen, width = this.canvas.width / this.scale;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = this.colour("paper");
    pen.fillRect(0, 0, this.canvas.width, this.canvas.height);
    const ground = this.gaits[visible[0] ?? 0];
    pen.setTransform(this.scale, 0, 0, -this.scale, 0, this.height * this.scale);
    // every walker goes at the same place on the screen, whatever its step length
    const camera = (gait) => fraction * gait.stride_length + this.ahead.get(gait);
    const inPlace = (gait, paint) => {
      pen.save();
      pen.translate(width / 2 - camera(gait), 0);
      paint();
      pen.restore();
    };
    const [first, ...others] = visible;
    if (first !== undefined) inPlace(ground, () => this.walker(ground, fraction));
    for (const i of others) inPlace(this.gaits[i], () => this.sticks(this.gaits[i], fraction));
    this.ground(camera(ground) + stride * ground.stride_length - width / 2, width);
    inPlace(ground, () => this.prints(ground, stride, fraction));
    for (const i of visible) {
      for (const leg of this.gaits[i].legs) {
        inPlace(this.gaits[i], () => this.reaction(leg, fraction));
      }
    }
  }

  walker(gait, fraction) {
    const pen = this.pen, own = this.colour("gait-" + gait.key), paper = this.colour("paper");
    const hip = between(gait.hip, fraction), top = between(gait.trunk_top, fraction);
    const pale = mixed(own, paper, LOOKS.shares.far_leg);
    const [near, far] = gait.legs;
    this.leg(far, hip, fraction, pale);
    const along = [top[0] - hip[0], top[1] - hip[1]], length = Math.hypot(...along);
    const up = along.map((v) => v / length), { above, radius } = LOOKS.head;
    const head = [top[0] + above * up[0], top[1] + above * up[1]];
    pen.fillStyle = mixed(own, this.colour("muted"), LOOKS.shares.trunk);
    this.limb(top, head, "neck");
    this.limb(hip, top, "trunk");
    this.disc(head, radius);
    this.leg(near, hip, fraction, own);
    // both hips are one point: leg 1 in front
    const apart = [LOOKS.hips_apart * up[1], -LOOKS.hips_apart * up[0]];
    this.powers(far, [hip[0] - apart[0], hip[1] - apart[1]], fraction);
    this.powers(near, [hip[0] + apart[0], hip[1] + apart[1]], fraction);
  }

  /* A walker laid over another one: lines alone, so that both are seen. */
  sticks(gait, fraction) {
    const pen = this.pen, own = this.colour("gait-" + gait.key), paper = this.colour("paper");
    const hip = between(gait.hip, fraction), top = between(gait.trunk_top, fraction);
    const [near, far] = gait.legs.map((leg) => {
      const at = (name) => between(leg[name], fraction);
      const foot = ["heel", "metatarsal", "ankle", "metatarsal", "toe_tip"].map(at);
      return [hip, at("knee"), at("ankle"), ...foot];
    });
    pen.lineJoin = pen.lineCap = "round";
    const pale = mixed(own, paper, LOOKS.shares.far_line);
    for (const [line, colour] of [[far, pale], [[hip, top], own], [near, own]]) {
      for (const [edge, width] of [[paper, 6], [colour, 3.5]]) {
        pen.strokeStyle = edge;
        pen.lineWidth = width * this.pixel;
        pen.beginPath();
        for (const p of line) pen.lineTo(p[0], p[1]);
        pen.stroke();
      }
    }
    for (const leg of gait.legs) this.powers(leg, hip, fraction);
  }

  leg(leg, hip, fraction, colour) {
    const pen = this.pen, at = (name) => between(leg[name], fraction);
    const knee = at("knee"), ankle = at("ankle"), ball = at("metatarsal");
    pen.fillStyle = pen.strokeStyle = colour;
    this.limb(hip, knee, "thigh");
    this.limb(knee, ankle, "shank");
    this.limb(ball, at("toe_tip"), "toes");
    pen.lineJoin = "round";
    pen.lineWidth = LOOKS.foot_edge;
    pen.beginPath();
    for (const p of [at("heel"), ankle, ball]) pen.lineTo(p[0], p[1]);
    pen.closePath();
    pen.fill();
    pen.stroke();
  }

  /* Joint power as colour and size of a disc. */
  powers(leg, hip, fraction) {
    const pen = this.pen, power = between(leg.power, fraction);
    const joints = [hip, ...["knee", "ankle", "metatarsal"].map((n) => between(leg[n], fraction))];
    joints.forEach((joint, k) => {
      if (power[k] === null) return; // not in the table of human means
      const share = Math.min(1, Math.abs(power[k]) / this.strongest);
      const end = this.colour(power[k] > 0 ? "power-up" : "power-down");
      pen.fillStyle = mixed(end, this.colour("power-none"), Math.sqrt(share));
      this.disc(joint, LOOKS.joint.least + LOOKS.joint.more * Math.sqrt(share));
      pen.strokeStyle = this.colour("ink");
      pen.lineWidth = this.pixel;
      pen.stroke();
    });
  }

  /* A limb between two points. */
  limb(p, q, name) {
    const [r, s] = LOOKS.limbs[name];
    const turn = Math.atan2(q[1] - p[1], q[0] - p[0]), pen = this.pen;
    pen.beginPath();
    pen.arc(p[0], p[1], r, turn + Math.PI / 2, turn - Math.PI / 2);
    pen.arc(q[0], q[1], s, turn - Math.PI / 2, turn + Math.PI / 2);
    pen.closePath();
    pen.fill();
  }

  disc(p, radius) {
    this.pen.beginPath();
    this.pen.arc(p[0], p[1], radius, 0, 2 * Math.PI);
    this.pen.fill();
  }

  /* The reaction as an arrow that begins at the centre of pressure. */
  reaction(leg, fraction) {
    const x = between(leg.pressure, fraction), force = between(leg.reaction, fraction);
    const length = LOOKS.per_weight * Math.hypot(...force), pen = this.pen;
    if (x === null || length < 0.02) return;
    const tip = [x + LOOKS.per_weight * force[0], LOOKS.per_weight * force[1]];
    const turn = Math.atan2(tip[1], tip[0] - x), side = LOOKS.arrow_head.turn;
    const head = Math.min(LOOKS.arrow_head.length, length / 2);
    const corner = (way) =>
      [tip[0] - head * Math.cos(turn + way), tip[1] - head * Math.sin(turn + way)];
    pen.lineCap = "round";
    for (const [colour, width] of [["paper", 5], ["arrow", 2.5]]) { // an edge to stand out
      pen.strokeStyle = this.colour(colour);
      pen.lineWidth = width * this.pixel;
      pen.beginPath();
      pen.moveTo(x, 0);
      pen.lineTo(...tip);
      pen.moveTo(...corner(side));
      pen.lineTo(...tip);
      pen.lineTo(...corner(-side));
      pen.stroke();
    }
    pen.fillStyle = this.colour("arrow");
    this.disc([x, 0], 4 * this.pixel);
  }

  /* The ground with a mark every half metre. */
  ground(left, width) {
    const pen = this.pen;
    pen.fillStyle = this.colour("ground");
    pen.fillRect(0, -LOOKS.below, width, LOOKS.below);
    pen.fillStyle = this.colour("muted");
    pen.fillRect(0, -this.pixel, width, this.pixel);
    for (let k = Math.ceil(2 * left) - 1; k / 2 < left + width; k++) {
      pen.fillRect(k / 2 - left, -(k % 2 ? 0.03 : 0.05), 1.5 * this.pixel, k % 2 ? 0.03 : 0.05);
      if (k % 2 === 0) this.write(`${k / 2} m`, k / 2 - left, -0.06);
    }
  }

  write(text, x, y) {
    const pen = this.pen, size = 12 * (window.devicePixelRatio || 1);
    pen.save();
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.font = `${size}px system-ui, sans-serif`;
    pen.textAlign = "center";
    pen.textBaseline = "top";
    pen.fillText(text, x * this.scale, (this.height - y) * this.scale);
    pen.restore();
  }

  /* Where the feet have stood flat: traces in the ground. */
  prints(gait, stride, fraction) {
    const pen = this.pen;
    gait.legs.forEach((leg, i) => {
      const flat = leg.phases.find((phase) => phase.name === "flat");
      if (!flat) return;
      const heel = between(leg.heel, flat.start)[0], toe = between(leg.toe_tip, flat.start)[0];
      for (let back = Math.min(stride, 4); back >= 0; back--) {
        if (back === 0 && fraction < flat.start) continue;
        pen.globalAlpha = i === 0 ? 0.8 : 0.4;
        pen.fillStyle = this.colour("muted");
        pen.fillRect(heel - back * gait.stride_length, -0.022, toe - heel, 0.02);
      }
    });
    pen.globalAlpha = 1;
  }
}

/* The contact phases of both legs of every gait, as bars over the stride. */
class PhaseBars {
  constructor(box, gaits) {
    this.rows = gaits.map((gait) =>
      gait.legs.flatMap((leg, k) => (leg.phases.length ? [this.row(gait, leg, k)] : [])));
    box.append(...this.rows.flat());
    this.cursors = [...box.querySelectorAll(".cursor")];
  }

  row(gait, leg, k) {
    const row = document.createElement("div"), bar = document.createElement("div");
    const name = document.createElement("span");
    row.className = "phase-row";
    bar.className = "bar";
    name.textContent = `leg ${k + 1}`;
    row.append(name, lineSample(gait.key), bar);
    bar.setAttribute("role", "img");
    const percent = (s) => Math.round(100 * s);
    const words = leg.phases.map((p) => `${p.name} ${percent(p.start)} to ${percent(p.end)} %`);
    bar.setAttribute("aria-label", `${gait.label}, leg ${k + 1}: ${words.join(", ")}`);
    for (const phase of leg.phases) {
      const span = document.createElement("span");
      span.className = phase.name;
      span.textContent = span.title = phase.name;
      span.style.left = 100 * phase.start + "%";
      span.style.width = 100 * (phase.end - phase.start) + "%";
      bar.append(span);
    }
    bar.append(cursorLine());
    return row;
  }

  show(visible) {
    this.rows.forEach((rows, i) => rows.forEach((r) => (r.hidden = !visible.includes(i))));
  }

  point(fraction) {
    for (const cursor of this.cursors) moveCursor(cursor, fraction);
  }
}

function cursorLine() {
  const track = document.createElement("div"), line = document.createElement("div");
  track.className = "track";
  line.className = "cursor";
  track.append(line);
  return track;
}

/* The cursor is as wide as its track, so that a shift in percent is one of the stride: a shift, other
   than a new place, costs the browser no new layout. */
function moveCursor(line, fraction) {
  line.style.transform = `translateX(${(100 * fraction).toFixed(3)}%)`;
}

/* Small multiples: every curve of leg 1 with the human band and a cursor. */
class CurveGrid {
  constructor(box, gaits) {
    this.gaits = gaits;
    this.charts = gaits[0].curves.map((curve, k) => this.chart(curve, k));
    box.append(...this.charts.map((chart) => chart.figure));
    this.plots = this.charts.map((chart) => chart.plot);
  }

  chart(curve, k) {
    const make = (tag, name) => Object.assign(document.createElement(tag), { className: name });
    const figure = make("figure", ""), caption = make("figcaption", ""), plot = make("div", "plot");
    const title = document.createElement("b"), unit = document.createElement("small");
    const values = make("div", "values"), picture = make("div", ""), track = cursorLine();
    title.textContent = curve.title;
    unit.textContent = `${curve.unit}, ${curve.positive} +`;
    caption.append(title, unit);
    values.setAttribute("aria-hidden", "true"); // it changes all the time
    plot.setAttribute("role", "img");
    plot.append(picture, track);
    figure.append(caption, plot, values);
    return { k, figure, plot, picture, cursor: track.firstChild, values };
  }

  show(visible) {
    this.visible = visible.filter((i) => this.gaits[i].curves.length); // human means are the band
    for (const chart of this.charts) this.redraw(chart);
  }

  redraw(chart) {
    const own = this.visible.map((i) => this.gaits[i].curves[chart.k]);
    const human = own[0]?.human;
    const band = human && [-1, 1].map((s) => human.mean.map((m, i) => m + s * human.sd[i]));
    const all = [...own.map((c) => c.values), ...(band || [])].flat();
    const low = Math.min(0, ...all), high = Math.max(low + 0.1, ...all);
    const y = (v) => (100 * (high - v)) / (high - low);
    const points = (v) => v.map((w, i) => `${(100 * i) / (v.length - 1)} ${y(w).toFixed(2)}`);
    const parts = [`<line class="zero" x1="0" x2="100" y1="${y(0)}" y2="${y(0)}"/>`];
    if (band) {
      const ring = [...points(band[0]), ...points(band[1]).reverse()];
      parts.unshift(`<path class="human-band" d="M${ring.join("L")}Z"/>`);
      parts.push(`<path class="human-mean" d="M${points(human.mean).join("L")}"/>`);
    }
    this.visible.forEach((i, n) => {
      const { key } = this.gaits[i];
      parts.push(`<path d="M${points(own[n].values).join("L")}" stroke="${gaitColour(key)}"
        stroke-width="2" stroke-dasharray="${DASHES[key]}"/>`);
    });
    const ticks = CurveGrid.ticks(low, high).map(
      (t) => `<span class="tick" style="top:${y(t)}%">${String(t).replace("-", "−")}</span>`);
    chart.picture.innerHTML = `<svg viewBox="0 0 100 100" preserveAspectRatio="none"
      aria-hidden="true">${parts.join("")}</svg>${ticks.join("")}`;
    chart.digits = high - low > 20 ? 0 : 2;
    chart.plot.setAttribute("aria-label", this.describe(own));
    chart.values.replaceChildren(...this.visible.map((i) => {
      const value = document.createElement("span");
      value.append(lineSample(this.gaits[i].key), document.createTextNode(""));
      return value;
    }));
  }

  describe(own) {
    if (!own.length) return "no gait is shown";
    const span = (c) => `${Math.min(...c.values)} to ${Math.max(...c.values)}`;
    return `${own[0].title} over the stride, ${own.map(span).join("; ")} ${own[0].unit}`;
  }

  /* Three to six round numbers between two others. */
  static ticks(low, high) {
    const rough = (high - low) / 4.5, power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
    const first = Math.ceil(low / step), last = Math.floor(high / step);
    const numbers = Array.from({ length: last - first + 1 }, (_, i) => (first + i) * step);
    return numbers.map((v) => Number(v.toPrecision(6)) + 0);
  }

  point(fraction) {
    for (const chart of this.charts) moveCursor(chart.cursor, fraction);
  }

  /* The values of the curves at the cursor, as figures. */
  tell(fraction) {
    for (const chart of this.charts) {
      this.visible.forEach((i, n) => {
        const value = between(this.gaits[i].curves[chart.k].values, fraction);
        const text = value.toFixed(chart.digits).replace(/^-(?=.*[1-9])/, "−").replace("-", "");
        chart.values.children[n].lastChild.textContent = " " + text;
      });
    }
  }
}
