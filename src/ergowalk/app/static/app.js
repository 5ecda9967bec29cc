"use strict";

/* The page of `ergowalk app`: a form, the solves that run, the viewer, and the gaits of the session.
   The server keeps everything but the form and what is shown; a reload loses neither solve nor gait. */

const MOST_SHOWN = 6; // the viewer has six colours
const find = (id) => document.getElementById(id);
const clone = (id) => find(id).content.firstElementChild.cloneNode(true);

/* Ask the server; the answer, or an error whose message is the server's sentence. */
async function ask(method, path, body, headers = {}) {
  let response;
  try {
    response = await fetch(path, { method, body, headers });
  } catch {
    throw new Error("The server does not answer; see whether it still runs, then try again.");
  }
  const text = await response.text();
  let answer = {};
  try {
    answer = JSON.parse(text);
  } catch {
    answer = { error: text };
  }
  if (response.ok) return answer;
  const error = new Error(answer.error || `The server answered ${response.status}.`);
  error.field = answer.field;
  throw error;
}

/* The form: a problem as the server gave it, with the values that the fields change. */
class ProblemForm {
  constructor(root, known, solve) {
    this.root = root;
    this.known = known;
    this.fields = [...root.querySelectorAll("[data-path]")];
    for (const preset of known.presets) find("preset").append(new Option(preset.name));
    for (const source of known.sources) find("source").append(new Option(source));
    find("preset").addEventListener("change", () => this.usePreset(find("preset").value));
    find("file").addEventListener("change", () => this.useFile(find("file").files[0]));
    find("speed").addEventListener("input", () => this.followSpeed());
    for (const path of ["step_length_m", "stride_time_s"]) {
      this.field(path).addEventListener("input", () => this.showSpeed());
    }
    find("scaled").addEventListener("change", () => this.enableSize());
    root.addEventListener("submit", (event) => {
      event.preventDefault();
      solve(this.asked());
    });
    this.enableSize();
    this.usePreset(known.preset);
    find("solve").disabled = false;
  }

  field(path) {
    return this.fields.find((field) => field.dataset.path === path);
  }

  usePreset(name) {
    const preset = this.known.presets.find((p) => p.name === name);
    find("preset").value = name;
    find("summary").textContent = preset.summary;
    this.forgetFile();
    this.fill(preset.problem);
  }

  forgetFile() {
    find("file").value = "";
    find("file-note").textContent = "";
  }

  async useFile(file) {
    this.refuse(null);
    if (!file) return;
    try {
      if (file.size > this.known.upload_limit) throw new Error(`${file.name}: ${this.known.too_large}`);
      const headers = { "X-File-Name": encodeURIComponent(file.name), "Content-Type": "application/toml" };
      const { problem } = await ask("POST", "/problem", file, headers);
      this.fill(problem);
      find("summary").textContent = "";
      find("preset").selectedIndex = -1;
      find("file-note").textContent = `The form has the values of ${file.name}.`;
    } catch (error) {
      this.forgetFile();
      this.refuse(Object.assign(error, { field: null, place: find("file") }));
    }
  }

  fill(problem) {
    this.problem = problem;
    for (const field of this.fields) {
      const value = at(problem, field.dataset.path);
      field.value = field.dataset.kind === "bound" && value === "off" ? "" : value;
    }
    find("rhythm").textContent = this.rhythm();
    find("scaled").checked = false;
    this.enableSize();
    this.showSpeed();
    this.refuse(null);
  }

  rhythm() {
    const { heel_end, heel_off, toe_off } = this.problem.rhythm;
    const instants = { "foot flat": heel_end, "heel-off": heel_off, "toe-off": toe_off };
    const percent = (v) => `${Number((100 * v).toFixed(1))}`;
    const words = Object.entries(instants).map(([name, value]) => Array.isArray(value)
      ? `${name} between ${percent(value[0])} and ${percent(value[1])} %` : `${name} at ${percent(value)} %`);
    return `Rhythm: ${words.join(", ")} of the stride. A problem file can fix or free it.`;
  }

  showSpeed() {
    const speed = (2 * number(this.field("step_length_m").value)) / number(this.field("stride_time_s").value);
    find("speed").value = Number.isFinite(speed) ? Number(speed.toPrecision(4)) : "";
  }

  followSpeed() {
    const time = (2 * number(this.field("step_length_m").value)) / number(find("speed").value);
    if (Number.isFinite(time) && time > 0) this.field("stride_time_s").value = Number(time.toPrecision(6));
  }

  enableSize() {
    for (const id of ["height", "mass", "sex"]) find(id).disabled = !find("scaled").checked;
  }

  /* What the server is asked: numbers as numbers, anything else as it stands for the server to judge. */
  asked() {
    const problem = structuredClone(this.problem);
    for (const field of this.fields) {
      const text = field.value.trim(), kind = field.dataset.kind;
      const value = kind === "bound" && !text ? "off" : kind === "text" ? field.value : spoken(text);
      set(problem, field.dataset.path, value);
    }
    const size = { height_m: spoken(find("height").value), mass_kg: spoken(find("mass").value) };
    if (find("sex").value) size.sex = find("sex").value;
    return find("scaled").checked ? { problem, size } : { problem };
  }

  /* Show why the server refused, below the field that it names; null clears. */
  refuse(error) {
    const note = find("refusal");
    find("solve").before(note);
    for (const field of this.root.querySelectorAll("[aria-invalid]")) {
      field.removeAttribute("aria-invalid");
      if (field.getAttribute("aria-describedby") === "refusal") field.removeAttribute("aria-describedby");
    }
    const named = { height_m: find("height"), mass_kg: find("mass") };
    const field = error?.field && (this.field(error.field) ?? named[error.field.split(".").pop()]);
    const place = error?.place ?? field;
    if (place) (place.closest(".joints") ?? place.closest("label") ?? place).after(note);
    note.hidden = !error;
    note.textContent = error ? error.message : "";
    if (!field) return;
    field.closest("details")?.setAttribute("open", "");
    field.setAttribute("aria-invalid", "true");
    if (!field.hasAttribute("aria-describedby")) field.setAttribute("aria-describedby", "refusal");
    field.focus();
  }
}

const at = (value, path) => path.split(".").reduce((inner, key) => inner[key], value);

function set(value, path, leaf) {
  const keys = path.split("."), last = keys.pop();
  keys.reduce((inner, key) => inner[key], value)[last] = leaf;
}

/* A number as people write it, with a point or a comma; NaN if it is none. */
function number(text) {
  const plain = text.trim().replace(",", ".");
  return /^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(plain) ? Number(plain) : NaN;
}

const spoken = (text) => (Number.isFinite(number(text)) ? number(text) : text || null);

/* One element for each item of a list, made once and kept, so that focus stays where it is. */
function keep(list, items, make, update) {
  const old = new Map([...list.children].map((element) => [element.dataset.id, element]));
  items.forEach((item, i) => {
    let element = old.get(item.id);
    old.delete(item.id);
    if (!element) {
      element = make(item);
      element.dataset.id = item.id;
    }
    if (list.children[i] !== element) list.insertBefore(element, list.children[i] ?? null);
    update(element, item);
  });
  for (const element of old.values()) element.remove();
}

function write(element, text) {
  if (element.textContent !== text) element.textContent = text;
}

/* Solves that wait, run, or ended without a gait. */
class OpenSolves {
  constructor(act) {
    this.act = act;
    this.list = find("open-solves");
    setInterval(() => this.tick(), 500);
  }

  show(jobs) {
    this.jobs = jobs.filter((job) => job.state !== "done");
    find("solves").hidden = !this.jobs.length;
    keep(this.list, this.jobs, (job) => this.card(job), (card, job) => this.update(card, job));
  }

  card(job) {
    const card = clone("open-solve"), title = card.querySelector(".title");
    title.textContent = `${job.number}: ${job.title}`;
    title.id = `solve-${job.number}`;
    if (this.reveal) requestAnimationFrame(() => card.scrollIntoView({ block: "nearest" }));
    this.reveal = false;
    const button = card.querySelector("button");
    button.setAttribute("aria-describedby", title.id);
    card.querySelector("progress").setAttribute("aria-describedby", title.id);
    button.addEventListener("click", () => {
      const open = card.dataset.open === "true";
      this.act(open ? "POST" : "DELETE", `/solves/${job.id}${open ? "/cancel" : ""}`);
    });
    return card;
  }

  update(card, job) {
    const running = job.state === "running", open = running || job.state === "waiting";
    card.dataset.open = open;
    card.since = running ? performance.now() - 1000 * job.seconds : null;
    card.querySelector("progress").hidden = !running;
    card.querySelector(".figures").hidden = !running;
    write(card.querySelector("button"), open ? "Cancel" : "Dismiss");
    card.querySelector(".words").classList.toggle("problem-note", job.state === "failed");
    const { stage, iteration, energy, violation } = job.progress;
    write(card.querySelector(".words"), {
      waiting: job.ahead ? `waits; ${job.ahead} before it` : "waits; it is next",
      running: stage || "starting",
      failed: `No gait: ${job.message}.`,
      cancelled: `No gait: ${job.message}.`,
    }[job.state]);
    write(card.querySelector(".iteration"), iteration == null ? "–" : String(iteration));
    write(card.querySelector(".energy"), energy == null ? "–" : `${energy.toFixed(2)} J/m`);
    write(card.querySelector(".violation"), violation == null ? "–" : violation.toExponential(1));
    this.tick();
  }

  progress(told) {
    for (const { id, progress, seconds } of told) {
      const job = this.jobs?.find((j) => j.id === id);
      if (job) this.update([...this.list.children].find((c) => c.dataset.id === id), Object.assign(job, { progress, seconds }));
    }
  }

  tick() {
    for (const card of this.list.children) {
      if (card.since === null) continue;
      write(card.querySelector(".time"), `${Math.max(0, Math.floor((performance.now() - card.since) / 1000))} s`);
    }
  }
}

/* The gaits of the session: which are shown, what can be downloaded. */
class GaitList {
  constructor(act, useProblem, selected) {
    this.act = act;
    this.useProblem = useProblem;
    this.selected = selected;
    this.shown = new Set(JSON.parse(sessionStorage.getItem("shown") || "[]"));
    this.known = null;
  }

  show(jobs) {
    const gaits = jobs.filter((job) => job.state === "done");
    const viewable = gaits.filter((gait) => gait.said.viewable).map((gait) => gait.id);
    const fresh = this.known && viewable.filter((id) => !this.known.has(id));
    const before = [...this.shown].filter((id) => viewable.includes(id));
    this.shown = new Set(fresh?.length ? fresh.slice(-1) : before);
    if (!this.shown.size && !this.known) this.shown = new Set(viewable.slice(-1));
    this.known = new Set(viewable);
    this.gaits = gaits;
    find("gaits-section").hidden = !gaits.length;
    this.render();
  }

  render() {
    const full = this.shown.size >= MOST_SHOWN;
    keep(find("gait-list"), [...this.gaits].reverse(), (gait) => this.card(gait), (card, gait) => {
      const box = card.querySelector(".show");
      box.checked = this.shown.has(gait.id);
      box.disabled = !gait.said.viewable || (full && !box.checked);
    });
    sessionStorage.setItem("shown", JSON.stringify([...this.shown]));
    this.selected(this.gaits.filter((gait) => this.shown.has(gait.id)));
  }

  card({ id, number, said }) {
    const card = clone("gait"), verdict = card.querySelector(".verdict");
    const name = card.querySelector(".name");
    name.textContent = said.label;
    name.id = `gait-${number}`;
    verdict.hidden = said.acceptable && said.viewable;
    verdict.textContent = [
      said.acceptable ? "" : `Not acceptable: ${said.status}.`,
      said.viewable ? "" : `It cannot be shown: ${said.why}.`,
    ].join(" ").trim();
    for (const file of [...said.files, ...(said.film ? [said.film] : [])]) {
      const link = Object.assign(document.createElement("a"), { href: `/solves/${id}/${file}`, download: file });
      link.textContent = file === said.film ? `${file} (takes a while)` : file;
      link.setAttribute("aria-describedby", name.id);
      card.querySelector(".downloads").append(link, " ");
    }
    for (const [label, text] of said.rows) {
      const row = card.querySelector("tbody").insertRow(), head = document.createElement("th");
      head.scope = "row";
      head.textContent = label;
      row.append(head);
      row.insertCell().textContent = text;
    }
    card.querySelector(".show").addEventListener("change", (event) => {
      this.shown[event.target.checked ? "add" : "delete"](id);
      this.render();
    });
    for (const button of card.querySelectorAll("button")) button.setAttribute("aria-describedby", name.id);
    card.querySelector(".again").addEventListener("click", () => this.useProblem(id));
    card.querySelector(".remove").addEventListener("click", () => this.act("DELETE", `/solves/${id}`));
    return card;
  }
}

/* The viewer of the selected gaits, made anew when the selection changes. */
class Stage {
  constructor(failed) {
    this.failed = failed;
    this.payloads = new Map();
    this.now = "";
    this.end = () => {};
  }

  async select(gaits) {
    const wanted = gaits.map((gait) => gait.id).join(" ");
    if (wanted === this.now) return;
    this.now = wanted;
    try {
      const payloads = await Promise.all(gaits.map((gait) => this.payload(gait.id)));
      if (wanted === this.now) this.play(payloads); // else something else was selected meanwhile
    } catch (error) {
      this.now = "";
      this.failed(error);
    }
  }

  async payload(id) {
    if (!this.payloads.has(id)) this.payloads.set(id, await ask("GET", `/solves/${id}/payload`));
    return this.payloads.get(id);
  }

  play(payloads) {
    this.end();
    this.end = () => {};
    find("stage").replaceChildren();
    find("empty").hidden = payloads.length > 0;
    if (!payloads.length) return;
    const root = clone("viewer");
    find("stage").append(root);
    this.end = ergowalkViewer(root, payloads);
  }
}

/* Tell a reader of the screen what changed, and the title of the tab. */
class News {
  constructor() {
    this.states = null;
    this.stages = new Map();
  }

  tell(jobs) {
    const words = [];
    for (const { id, number, state, said, message } of jobs) {
      if (this.states && this.states.get(id) !== state) words.push(`Solve ${number}: ${said.label || message || state}.`);
    }
    this.states = new Map(jobs.map((job) => [job.id, job.state]));
    if (words.length) find("news").textContent = words.join(" ");
    const running = jobs.filter((job) => job.state === "running").length;
    document.title = running ? "Solving… – ergowalk" : "ergowalk";
  }

  stage(told) {
    for (const { id, progress } of told) {
      if (!progress.stage || this.stages.get(id) === progress.stage) continue;
      this.stages.set(id, progress.stage);
      find("news").textContent = progress.stage;
    }
  }
}

async function begin() {
  const complain = (error) => {
    find("connection").hidden = !error;
    find("connection").textContent = error ? error.message : "";
  };
  let known;
  try {
    known = await ask("POST", "/session");
  } catch (error) {
    complain(error);
    return;
  }
  const act = (method, path) => ask(method, path).then(() => complain(null), complain);
  const form = new ProblemForm(find("form"), known, async (asked) => {
    find("solve").disabled = true;
    solves.reveal = true; // its card may be here before the answer
    try {
      await ask("POST", "/solves", JSON.stringify(asked), { "Content-Type": "application/json" });
      form.refuse(null);
    } catch (error) {
      solves.reveal = false;
      form.refuse(error);
    }
    find("solve").disabled = false;
  });
  const useProblem = async (id) => {
    try {
      form.forgetFile();
      form.fill((await ask("GET", `/solves/${id}/problem`)).problem);
      find("preset").selectedIndex = -1;
      find("summary").textContent = "The form has the values of a gait below.";
      find("form-title").scrollIntoView({ block: "nearest" });
      form.field("name").focus();
    } catch (error) {
      complain(error);
    }
  };
  const solves = new OpenSolves(act), stage = new Stage(complain), news = new News();
  const gaits = new GaitList(act, useProblem, (selected) => stage.select(selected));

  const events = new EventSource("/events");
  events.addEventListener("state", (event) => {
    const jobs = JSON.parse(event.data);
    complain(null);
    solves.show(jobs);
    gaits.show(jobs);
    news.tell(jobs);
  });
  events.addEventListener("progress", (event) => {
    const told = JSON.parse(event.data);
    solves.progress(told);
    news.stage(told);
  });
  events.addEventListener("error", () => {
    complain(new Error(events.readyState === EventSource.CLOSED
      ? "The server was started anew and no longer knows this page; load it again."
      : "The server does not answer; this page goes on as soon as it does."));
  });
}

begin();
