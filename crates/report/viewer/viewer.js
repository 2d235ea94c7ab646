// Puts film, slope, chart, panel and player together, and handles keys and pointers.

const by = (id) => document.getElementById(id);
const MAGNIFICATIONS = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000];
const CURSOR_STEP = 8; // Way of the cursor with each key (px).
const WAYS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };
const CROSSES = "Principal stresses as crosses: compression thin, tension thick with bars at its ends";
const POLL = 1000; // Time between two questions to the server of a film that grows (ms).

class Viewer {
  constructor(film) {
    this.film = film;
    this.slope = new Slope(by("slope"), film);
    this.chart = new Chart(by("chart"));
    this.player = new Player(film, () => this.refresh());
    this.colour = coloursOf(film)[0];
    this.choice = { block: null, monitor: null, element: null, joint: null };
    this.settings = { magnification: 1, sinceStage: false, logarithmic: false, crosses: false, structures: true };
    // Pixel of the canvas that keys have moved to, or null.
    this.cursor = null;
    this.marks = [];
    this.theme = {};
    this.due = false;
    this.open();
  }

  open() {
    this.buildColours();
    this.buildSpeeds();
    this.listen();
    this.range();
    this.setTheme(matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light");
    this.update();
    this.slope.resize();
    this.slope.fit();
    this.follow(location.hash);
  }

  // Makes tables, charts, ranges and the length of the slider again, for a film that has grown.
  update() {
    const { film } = this,
      { head } = film;
    document.title = `${head.title || head.case_file} – enmm ${head.command}`;
    by("title").textContent = head.title || head.case_file;
    by("subtitle").textContent = this.subtitle();
    const end = film.of("end").at(-1);
    by("status").textContent = end
      ? end.status === "finished"
        ? ""
        : end.status
      : film.live
        ? "still running"
        : "not finished";
    by("status").classList.toggle("bad", Boolean(end) && end.status !== "finished");
    const marked = film.of("marked");
    while (this.marks.length < marked.length) this.marks.push(this.marks.length === 0);
    by("timeline").hidden = film.frames.length < 2 && !film.rows.time.length;
    [by("slider").min, by("slider").max] = [film.start, film.end];
    this.base = this.greatest = undefined;
    this.buildPanel();
    this.buildCharts();
    this.range();
    this.refresh();
  }

  buildColours() {
    by("colours").replaceChildren(
      ...coloursOf(this.film).map((colour) => {
        const place = COLOURS.indexOf(colour) + 1;
        const title = place ? `${colour.name} (${place})` : colour.name;
        const button = element(
          "button",
          { type: "button", role: "radio", "data-colour": colour.key, title },
          colour.name,
        );
        button.addEventListener("click", () => this.setColour(colour));
        return button;
      }),
    );
  }

  buildSpeeds() {
    const speeds = this.player.speeds(),
      unit = this.film.head.axis.unit;
    const options = [...new Set(speeds)]
      .sort((a, b) => a - b)
      .map((speed) =>
        element(
          "option",
          { value: speed, selected: speed === speeds[0] },
          `${Number(speed.toPrecision(3))} ${unit}`.trim() + " per second",
        ),
      );
    by("speed").replaceChildren(...options);
  }

  buildPanel() {
    const toggle = (k, shown) => {
      this.marks[k] = shown;
      this.refresh();
    };
    const held = by("panel").scrollTop;
    by("panel").replaceChildren(
      ...this.film.of("verdict").slice(-1).map(verdictSection),
      element("section", { id: "probe" }),
      element("section", { id: "choice" }),
      ...panelSections(this.film, this.marks, toggle),
      this.settingsSection(),
      caseSection(this.film),
      accuracySection(this.film),
    );
    by("panel").scrollTop = held;
    this.shownChoice = "";
  }

  settingsSection() {
    const { settings } = this;
    const place = MAGNIFICATIONS.indexOf(settings.magnification);
    const slider = element("input", {
      id: "magnify",
      type: "range",
      min: 0,
      max: MAGNIFICATIONS.length - 1,
      value: place,
    });
    const shown = element("output", {}, `${settings.magnification} ×`);
    slider.addEventListener("input", () => {
      settings.magnification = MAGNIFICATIONS[Number(slider.value)];
      shown.textContent = `${settings.magnification} ×`;
      this.refresh();
    });
    const box = (id, text, key) => {
      const input = element("input", { id, type: "checkbox", checked: settings[key] });
      input.addEventListener("change", () => {
        settings[key] = input.checked;
        this.range();
        this.refresh();
      });
      return element("label", {}, input, text);
    };
    const since =
      this.film.of("stage").length > 1
        ? [box("since-stage", "Displacements since the start of the stage", "sinceStage")]
        : [];
    const signs = element(
      "p",
      { class: "soft" },
      "△ held, ○ held along one axis, □ boundary that lets waves out; bolts with their greatest tension, thick when " +
        "they yield, dashed when broken; water along edges, the thicker the greater its pressure.",
    );
    return section(
      "Drawing",
      element("label", {}, "Displacements drawn", slider, shown),
      ...since,
      box("logarithmic", "Logarithmic colours, three decades", "logarithmic"),
      ...(this.film.frames.some(({ elements }) => elements) ? [box("crosses", CROSSES, "crosses")] : []),
      ...(hasStructures(this.film) ? [box("structures", "Bolts, supports and water", "structures"), signs] : []),
    );
  }

  buildCharts() {
    const charts = [
        ...chartsOf(this.film),
        ...chartsOfBlock(this.film, this.choice.block),
        ...chartsOfProbe(this.film, this.choice),
      ],
      wanted = by("chart-quantity").value;
    this.charts = charts;
    by("chart-quantity").replaceChildren(
      ...charts.map((chart) => element("option", { value: chart.name }, chart.name)),
    );
    const chosen = charts.find((chart) => chart.name === wanted) ?? charts[0] ?? null;
    if (chosen) by("chart-quantity").value = chosen.name;
    this.setChart(chosen);
    by("chart").hidden = by("chart-bar").hidden = !charts.length;
  }

  setChart(chart) {
    this.chart.show(chart);
    by("chart-names").replaceChildren(
      ...(chart?.series ?? []).map(({ name }, k) => {
        const { colour, dash } = seriesStyle(k, this.theme);
        return element("span", {}, line(colour, 2.5, dash), name);
      }),
    );
    this.refresh();
  }

  setColour(colour) {
    this.colour = colour;
    for (const button of by("colours").children)
      button.setAttribute("aria-checked", button.dataset.colour === colour.key);
    this.range();
    this.refresh();
  }

  setTheme(name) {
    document.documentElement.dataset.theme = name;
    by("theme").textContent = name === "dark" ? "Light" : "Dark";
    const style = getComputedStyle(document.documentElement);
    for (const key of ["paper", "ink", "soft", "line", "accent", "mark", "edge", "halo", "water", "bolt"])
      this.theme[key] = style.getPropertyValue(`--${key}`);
    this.theme.dark = name === "dark";
    this.setColour(this.colour);
    if (this.charts) this.setChart(this.chart.chart);
  }

  choose({ block = null, monitor = null, element = null, joint = null }) {
    this.choice = { block, monitor, element, joint };
    this.buildCharts();
    this.refresh();
  }

  // The frame from which displacements count: that in which the stage of now begins.
  baseFrame() {
    if (!this.settings.sinceStage) return null;
    const stage = this.film
      .of("stage")
      .filter(({ start }) => start <= this.player.time)
      .at(-1);
    return stage ? this.film.frameAt(stage.start) : null;
  }

  // Finds the range of the colours, which stays the same over the film so that colours compare.
  range() {
    if (!this.colour.ramp) return this.showLegend();
    const base = this.baseFrame();
    this.ranged = base;
    this.limits = rangeOf(
      this.film,
      this.colour,
      base === null ? this.film.frames : this.film.frames.slice(base),
      this.film.frames[base],
    );
    this.showLegend();
  }

  showLegend() {
    const { colour } = this,
      legend = by("legend");
    if (colour.key === "joint") {
      const bridged = this.film.frames.some((frame) => frame.edges?.some((state) => state >= BRIDGE));
      const states = [LOCK, SLIP, OPEN, ...(bridged ? [BRIDGE, BROKEN_BRIDGE] : [])];
      const styles = states.map((state) => jointStyle(state, this.theme));
      legend.replaceChildren(
        ...styles.map((style) => element("div", {}, line(style.colour, style.width, style.dash), style.name)),
      );
    } else if (!colour.ramp) {
      legend.replaceChildren("Colours only set blocks apart");
    } else {
      const logarithmic = this.settings.logarithmic && colour.logarithmic;
      const low = logarithmic ? this.limits[1] / 1000 : this.limits[0],
        shown = unitFor(colour.unit, Math.max(...this.limits.map(Math.abs)));
      const bar = element("div", { class: "bar" });
      bar.style.background = `linear-gradient(to right, ${RAMPS[colour.ramp].join(", ")})`;
      const end = (value) => element("span", {}, digits(value / shown.weight).replace("-", "−"));
      const note =
        colour.key === "stress"
          ? ", tension positive"
          : this.ranged !== null && !colour.ofJoints
            ? ", since the start of the stage"
            : "";
      legend.replaceChildren(
        `${colour.name}${shown.name && ` (${shown.name})`}${note}${logarithmic ? ", logarithmic" : ""}`,
        bar,
        element(
          "div",
          { class: "ends" },
          end(low),
          ...(logarithmic ? [] : [end(0.5 * (low + this.limits[1]))]),
          end(this.limits[1]),
        ),
      );
    }
  }

  // Draws once before the screen shows its next picture, however often it is asked.
  refresh() {
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => {
      this.due = false;
      this.draw();
    });
  }

  // Shows other blocks where some have broken; a block that is chosen stays so by its number, or as its whole.
  showShape(shape) {
    const { film, choice } = this;
    if (film.shape === shape) return;
    if (choice.block !== null) choice.block = placesIn(film.shape, shape)[choice.block];
    [choice.element, choice.joint] = [null, null];
    film.shape = shape;
    by("subtitle").textContent = this.subtitle();
  }

  subtitle() {
    const { head, shape, frames } = this.film;
    return `enmm ${head.command}, version ${head.version}, ${fileName(head)}, ${counted(shape.count, "block")}, ${counted(frames.length, "frame")}`;
  }

  draw() {
    const { film, player, slope, settings } = this;
    if (!film.frames.length) return;
    slope.resize();
    const moment = player.moment(),
      base = this.baseFrame();
    if (settings.sinceStage && base !== this.ranged && this.colour.ramp) this.range();
    const frame = film.frames[moment.from];
    this.showShape(frame.shape);
    slope.pose(moment, settings.magnification, base);
    this.monitors = this.monitorsNow(moment, base);
    const marks = film
      .of("marked")
      .filter((_, k) => this.marks[k])
      .map(({ blocks }) => blocks.map((id) => film.shape.places.get(id)).filter((k) => k !== undefined));
    const { magnification, structures } = settings,
      bolts = structures ? boltsNow(film, moment, base, magnification) : null;
    const over = { joints: this.colour.key === "joint", marks, monitors: this.monitors, bolts, ...this.choice };
    Object.assign(over, this.partsNow(frame, base), { cursor: this.cursor });
    slope.draw(frame, this.paint(frame, base), over, this.theme);
    this.showNumbers(frame, moment);
  }

  // Elements, joints and crosses of a frame, as they are drawn; null where there is nothing of them.
  partsNow(frame, base) {
    const { colour, settings } = this,
      logarithmic = settings.logarithmic && colour.logarithmic;
    if (!frame.elements) return { elements: null, moved: null, crosses: null };
    const key = [colour.key, this.limits, logarithmic, base].join(" ");
    if (this.steps?.frame !== frame || this.steps.key !== key) {
      const numbers = colour.ofJoints
        ? numbersOfJoints(frame, colour.key)
        : numbersOfElements(frame, colour.key, this.film.under(this.film.frames[base]));
      const step = (value) => (Number.isNaN(value) ? 255 : stepOf(value, this.limits, logarithmic));
      this.steps = { frame, key, steps: numbers && Uint8Array.from(numbers, step) };
    }
    const { steps } = this.steps,
      parts = steps && { steps, colours: RAMPS[colour.ramp], words: WORDS[colour.ramp] };
    if (settings.crosses)
      this.greatest ??= rangeOfParts(this.film.frames, (shown) => numbersOfElements(shown, "shear"), false)[1];
    return {
      elements: colour.ofJoints ? null : parts,
      moved: colour.ofJoints ? parts : null,
      crosses: settings.crosses ? this.greatest : null,
    };
  }

  // The colour of each block; none where all are alike.
  paint(frame, base) {
    const { colour, theme, film } = this;
    if (colour.key === "joint" || colour.ofJoints) return null;
    if (colour.key === "block")
      return (k) =>
        film.shape.blocks[k].fixed ? theme.line : BLOCK_FILLS[film.shape.blocks[k].id % BLOCK_FILLS.length];
    const steps = RAMPS[colour.ramp],
      logarithmic = this.settings.logarithmic && colour.logarithmic,
      from = film.under(film.frames[base]);
    return (k) => steps[stepOf(colour.value(frame, k, from), this.limits, logarithmic)];
  }

  monitorsNow({ from, to, part }, base) {
    const { film, settings } = this,
      { originX, originY } = film.shape;
    return film.head.monitors.map(({ name, place }, k) => {
      const a = film.frames[from].monitors[k],
        b = film.frames[to].monitors[k];
      const at = base === null ? { ux: 0, uy: 0 } : film.frames[base].monitors[k];
      const now = (key) => at[key] + settings.magnification * (a[key] + (b[key] - a[key]) * part - at[key]);
      return { name, x: place[0] - originX + now("ux"), y: place[1] - originY + now("uy") };
    });
  }

  showNumbers(frame, moment) {
    const { film, player, settings } = this,
      axis = film.head.axis;
    const stages = film.of("stage"),
      stage = stages.find(({ number }) => number === frame.stage);
    by("clock").textContent =
      `${axis.name} ${`${player.time.toFixed(3)} ${axis.unit}`.trim()}${stage ? `, stage ${stage.name}` : ""}, frame ${moment.from + 1} of ${film.frames.length}`;
    by("slider").value = player.time;
    by("slider").setAttribute("aria-valuetext", `${digits(player.time)} ${axis.unit}`);
    by("play").textContent = player.playing ? "Pause" : "Play";
    by("note").textContent = settings.magnification > 1 ? `displacements drawn ${settings.magnification} ×` : "";
    if (!by("chart").hidden) this.chart.draw(player.time, [film.start, film.end], stages, this.theme);
    this.showScale();
    for (const row of document.querySelectorAll("#stages tr[data-stage]"))
      row.classList.toggle("now", Number(row.dataset.stage) === frame.stage);
    const shown = `${Object.values(this.choice).join(" ")} ${moment.from}`;
    if (shown === this.shownChoice) return;
    this.shownChoice = shown;
    by("choice").replaceWith(choiceSection(film, this.choice, frame));
    by("probe").replaceWith(probeSection(this.choice, frame));
    const heads = document.querySelectorAll("#probe h2, #choice h2"),
      found = this.cursor ? Array.from(heads, (head) => head.textContent).join(", ") : "";
    if (by("found").textContent !== found) by("found").textContent = found;
  }

  showScale() {
    const metres = roundUp(60 / this.slope.camera.scale),
      bar = by("scale-bar").firstElementChild;
    bar.style.width = `${metres * this.slope.camera.scale}px`;
    bar.textContent = metres < 1 ? `${Number((metres * 1000).toPrecision(3))} mm` : `${metres} m`;
  }

  listen() {
    const { player, slope } = this;
    by("play").addEventListener("click", () => player.toggle());
    by("back").addEventListener("click", () => player.step(-1));
    by("forward").addEventListener("click", () => player.step(1));
    by("slider").addEventListener("input", () => {
      player.pause();
      player.seek(Number(by("slider").value));
    });
    by("speed").addEventListener("change", () => {
      player.speed = Number(by("speed").value);
    });
    by("chart-quantity").addEventListener("change", () =>
      this.setChart(this.charts.find(({ name }) => name === by("chart-quantity").value)),
    );
    by("theme").addEventListener("click", () => this.switchTheme());
    by("toggle-panel").addEventListener("click", () => this.togglePanel());
    const act = (id, work) =>
      by(id).addEventListener("click", () => {
        work();
        this.refresh();
      });
    act("zoom-in", () => slope.zoom(1.5));
    act("zoom-out", () => slope.zoom(1 / 1.5));
    act("zoom-fit", () => slope.fit());
    new ResizeObserver(() => this.refresh()).observe(by("view"));
    document.addEventListener("keydown", (event) => this.key(event));
    this.listenToPointers();
    this.listenToSaves();
  }

  switchTheme() {
    this.setTheme(document.documentElement.dataset.theme === "dark" ? "light" : "dark");
  }

  togglePanel() {
    const hidden = document.querySelector("main").classList.toggle("wide");
    by("toggle-panel").textContent = hidden ? "Show panel" : "Hide panel";
    by("toggle-panel").setAttribute("aria-expanded", !hidden);
  }

  listenToSaves() {
    const name = fileName(this.film.head).replace(/\.[^.]*$/, "") || "slope";
    by("help").addEventListener("click", () => this.showKeys());
    by("save-picture").addEventListener("click", () =>
      this.picture().toBlob((blob) => offer(blob, `${name}_${digits(this.player.time)}.png`)),
    );
    by("save-table").addEventListener("click", () =>
      offer(new Blob([csvOf(this.film)], { type: "text/csv" }), `${name}_history.csv`),
    );
    by("save-table").hidden = !this.film.rows.time.length;
    by("save-film").hidden = !window.MediaRecorder || !by("slope").captureStream;
    by("save-film").addEventListener("click", () => this.record(`${name}.webm`));
    by("copy-link").addEventListener("click", () => this.copyLink());
    window.addEventListener("hashchange", () => this.follow(location.hash));
  }

  showKeys() {
    const rows = KEYS.map(([key, act]) =>
      element("tr", {}, element("th", { scope: "row" }, element("kbd", {}, key)), element("td", {}, act)),
    );
    by("keys").querySelector("tbody").replaceChildren(...rows);
    by("keys").showModal();
  }

  // The slope on its paper with title and moment, as another canvas.
  picture() {
    this.draw();
    const slope = by("slope"),
      ratio = slope.width / (slope.clientWidth || 1),
      head = Math.round(44 * ratio);
    const made = element("canvas", { width: slope.width, height: slope.height + head }),
      pen = made.getContext("2d");
    pen.fillStyle = this.theme.paper;
    pen.fillRect(0, 0, made.width, made.height);
    pen.drawImage(slope, 0, head);
    pen.fillStyle = this.theme.ink;
    pen.font = `${15 * ratio}px system-ui, sans-serif`;
    pen.fillText(by("title").textContent, 10 * ratio, 18 * ratio, made.width - 20 * ratio);
    pen.font = `${12 * ratio}px system-ui, sans-serif`;
    pen.fillText(`${this.colour.name}; ${by("clock").textContent}`, 10 * ratio, 36 * ratio, made.width - 20 * ratio);
    return made;
  }

  // Plays the film from its start and saves what is shown.
  record(name) {
    const recorder = new MediaRecorder(by("slope").captureStream(30)),
      parts = [];
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    recorder.addEventListener("stop", () => {
      by("save-film").disabled = false;
      offer(new Blob(parts, { type: recorder.mimeType }), name);
    });
    by("save-film").disabled = true;
    this.player.pause();
    this.player.seek(this.film.start);
    recorder.start();
    this.player.toggle();
    const watch = setInterval(() => {
      if (this.player.playing) return;
      clearInterval(watch);
      // The last picture stays for a moment.
      setTimeout(() => recorder.stop(), 300);
    }, 100);
  }

  // Puts the moment and the colour into the address, and that into the clipboard where the browser lets it.
  copyLink() {
    location.hash = `t=${Number(this.player.time.toPrecision(9))}&colour=${this.colour.key}`;
    navigator.clipboard?.writeText(location.href).catch(() => {});
    by("copy-link").textContent = "In the address bar";
    setTimeout(() => (by("copy-link").textContent = "Link"), 2000);
  }

  // Goes to the moment and the colour of a link; what it does not name, or names wrongly, stays.
  follow(hash) {
    const wanted = new URLSearchParams(hash.replace(/^#/, "")),
      time = wanted.get("t");
    by("colours").querySelector(`[data-colour="${CSS.escape(wanted.get("colour") ?? "")}"]`)?.click();
    if (time !== null && time !== "" && Number.isFinite(Number(time))) this.player.seek(Number(time));
  }

  // What a reader has chosen: the part of the section in sight, unless it is the whole slope, colour and theme.
  sight() {
    const { camera, fitted } = this.slope,
      { originX, originY } = this.film.shape;
    const part = fitted ? null : { x: camera.x + originX, y: camera.y + originY, scale: camera.scale };
    return { part, colour: this.colour.key, theme: document.documentElement.dataset.theme };
  }

  // Takes over what was chosen for another model of the section.
  see({ part, colour, theme }) {
    const { originX, originY } = this.film.shape;
    if (part) {
      this.slope.camera = { x: part.x - originX, y: part.y - originY, scale: part.scale };
      this.slope.fitted = false;
    }
    this.setTheme(theme);
    by("colours").querySelector(`[data-colour="${CSS.escape(colour)}"]`)?.click();
    this.refresh();
  }

  listenToPointers() {
    const canvas = by("slope"),
      down = new Map();
    let moved = false;
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      down.set(event.pointerId, [event.offsetX, event.offsetY]);
      moved = down.size > 1;
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = down.get(event.pointerId),
        now = [event.offsetX, event.offsetY];
      if (!before || (!moved && Math.hypot(now[0] - before[0], now[1] - before[1]) < 4)) return;
      moved = true;
      canvas.classList.add("drag");
      this.drag(down, event.pointerId, before, now);
      down.set(event.pointerId, now);
      this.refresh();
    });
    const up = (event) => {
      if (down.delete(event.pointerId) && !moved && event.type === "pointerup")
        this.click(event.offsetX, event.offsetY);
      canvas.classList.remove("drag");
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener(
      "wheel",
      (event) => {
        event.preventDefault();
        this.slope.zoom(Math.exp(-Math.max(-200, Math.min(200, event.deltaY)) * 0.002), event.offsetX, event.offsetY);
        this.refresh();
      },
      { passive: false },
    );
    const seek = (event) => this.player.seek(this.chart.timeAt(event.offsetX, [this.film.start, this.film.end]));
    by("chart").addEventListener("pointerdown", (event) => {
      by("chart").setPointerCapture(event.pointerId);
      this.player.pause();
      seek(event);
    });
    by("chart").addEventListener("pointermove", (event) => {
      if (event.buttons) seek(event);
    });
  }

  // One pointer pans, two zoom.
  drag(down, id, before, now) {
    const others = [...down].filter(([other]) => other !== id);
    if (!others.length) return this.slope.pan(now[0] - before[0], now[1] - before[1]);
    const [, [x, y]] = others[0],
      apart = (place) => Math.hypot(place[0] - x, place[1] - y);
    this.slope.zoom(apart(now) / (apart(before) || 1), x, y);
  }

  click(px, py) {
    const frame = this.film.frames[this.player.moment().from];
    this.choose(this.slope.pick(px, py, frame, this.monitors));
  }

  // Moves the place that keys choose, and chooses what is there.
  moveCursor([dx, dy]) {
    const { clientWidth, clientHeight } = by("slope"),
      [px, py] = this.cursor ?? [clientWidth / 2, clientHeight / 2];
    const far = this.cursor ? CURSOR_STEP : 0;
    this.cursor = [
      Math.max(0, Math.min(clientWidth, px + far * dx)),
      Math.max(0, Math.min(clientHeight, py + far * dy)),
    ];
    this.click(...this.cursor);
  }

  key(event) {
    const { target, key } = event;
    if (by("keys").open) return key === "Escape" && by("keys").close();
    if (event.ctrlKey || event.metaKey || event.altKey || target.tagName === "SELECT" || target.id === "magnify")
      return;
    // A focused button or summary takes the space bar itself.
    if (key === " " && ["BUTTON", "SUMMARY", "INPUT"].includes(target.tagName) && target.id !== "slider") return;
    const { player, slope } = this,
      way = event.shiftKey && WAYS[key];
    if (way && target.type !== "range") {
      event.preventDefault();
      return this.moveCursor(way);
    }
    const acts = {
        " ": () => player.toggle(),
        ArrowLeft: () => player.step(-1),
        ArrowRight: () => player.step(1),
        Home: () => player.seek(this.film.start),
        End: () => player.seek(this.film.end),
        "+": () => slope.zoom(1.5),
        "=": () => slope.zoom(1.5),
        "-": () => slope.zoom(1 / 1.5),
        0: () => slope.fit(),
        d: () => this.switchTheme(),
        "?": () => this.showKeys(),
        Escape: () => {
          this.cursor = null;
          this.choose({});
        },
      };
    const colour = by("colours").querySelector(`[data-colour="${COLOURS[Number(key) - 1]?.key}"]`);
    const act = colour ? () => colour.click() : acts[key];
    if (!act) return;
    event.preventDefault();
    act();
    this.refresh();
  }
}

// Saves bytes under a name.
function offer(blob, name) {
  const link = element("a", { href: URL.createObjectURL(blob), download: name });
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

// The histories as CSV, with the names of history.csv as far as the film has them.
function csvOf(film) {
  const cell = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  const head = film.head.columns.map(({ name, unit }) => cell(unit ? `${name} [${unit}]` : name));
  const columns = film.head.columns.map((_, c) => (c === 0 ? film.rows.time : film.rows.columns[c]));
  const rows = film.rows.time.map((_, k) => columns.map((column) => column[k]).join(","));
  return [head.join(","), ...rows, ""].join("\n");
}

// A piece of a line for legends.
function line(colour, width, dash) {
  const made = element("i", { class: "line" });
  made.style.borderTop = `${width}px ${dash.length === 0 ? "solid" : dash[0] > 4 ? "dashed" : "dotted"} ${colour}`;
  return made;
}

function fail(message) {
  by("title").textContent = "This report cannot be shown";
  by("status").textContent = message;
  by("status").className = "bad";
}

// Asks the server for what a film has grown by, until it ends.
async function follow(film) {
  let from = 0,
    viewer = null;
  for (;;) {
    const answer = await fetch(`/film?from=${from}`);
    // The run has begun again: the film is shorter than what was read.
    if (answer.status === 416) return location.reload();
    const bytes = new Uint8Array(await answer.arrayBuffer());
    from += bytes.length;
    if (bytes.length && (await film.push(bytes)) && film.frames.length) viewer = grow(viewer, film);
    if (film.of("end").length) return;
    if (!bytes.length) await new Promise((resolve) => setTimeout(resolve, POLL));
  }
}

// Shows a film that has grown; a viewer at its end moves on with it.
function grow(viewer, film) {
  if (!viewer) return (window.enmm = new Viewer(film));
  const atEnd = viewer.player.time >= Number(by("slider").max);
  viewer.update();
  if (atEnd && !viewer.player.playing) viewer.player.seek(film.end);
  return viewer;
}

async function start() {
  if (!window.DecompressionStream) return fail("This browser is too old: it needs the one of 2023 or later.");
  const film = new Film(),
    embedded = by("film");
  try {
    if (embedded) {
      await film.push(fromBase64(embedded.textContent.trim()));
      embedded.remove();
      if (!film.frames.length) return fail("The run ended before its first frame.");
      grow(null, film);
    } else {
      film.live = true;
      by("title").textContent = "Waiting for the first frame …";
      await follow(film);
    }
  } catch (error) {
    fail(
      embedded
        ? `The film in this page is damaged (${error.message}).`
        : `The run is not served any more (${error.message}).`,
    );
    throw error;
  }
}

start();
