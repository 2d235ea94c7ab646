// The panel beside the slope: numbers of what is chosen, tables, settings, the case.

// An element with attributes and children; text is never read as HTML.
function element(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === true) made.setAttribute(key, "");
    else if (value !== false && value !== null) made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

function table(rows) {
  const row = ([name, value, exact]) => {
    const shown = element("td", exact === undefined ? {} : { title: exact }, value);
    return element("tr", {}, element("th", { scope: "row" }, name), shown);
  };
  return element("table", {}, element("tbody", {}, ...rows.map(row)));
}

// A row of a table: the value with a unit for reading, and in the unit of the film under the pointer.
function measured(name, value, unit) {
  return [name, withUnit(value, unit), `${value} ${unit}`];
}

// A coordinate: always in metres, so that two of one place compare.
function placed(name, value) {
  return [name, `${Number(value.toFixed(4))} m`.replace("-", "−"), `${value} m`];
}

function section(title, ...children) {
  return element("section", {}, element("h2", {}, title), ...children);
}

function folded(title, open, ...children) {
  return element("details", { open }, element("summary", {}, title), ...children);
}

// Greater and smaller principal stress in the plane (Pa), and the angle of the greater from the x axis (rad).
function principal(xx, yy, xy) {
  const mean = 0.5 * (xx + yy),
    radius = Math.hypot(0.5 * (xx - yy), xy);
  return [mean + radius, mean - radius, 0.5 * Math.atan2(2 * xy, xx - yy)];
}

function numbersOfBlock(film, k, frame) {
  const block = film.shape.blocks[k],
    { shape, head } = film,
    rock = head.rocks[block.rock];
  const state = frame.removed[k] ? "excavated" : block.fixed ? "held" : "free";
  return [
    ["State", rock ? `${state}, ${rock}` : state],
    measured("Area", block.area, "m²"),
    measured("Mass", block.mass, "kg/m"),
    placed("Centroid x", shape.originX + shape.centreX[k] + frame.displacement_x[k]),
    placed("Centroid y", shape.originY + shape.centreY[k] + frame.displacement_y[k]),
    measured("Displacement", Math.hypot(frame.displacement_x[k], frame.displacement_y[k]), "m"),
    measured("… x", frame.displacement_x[k], "m"),
    measured("… y", frame.displacement_y[k], "m"),
    measured("Rotation", frame.rotation[k], "rad"),
    ...(film.has("velocity") ? velocityOfBlock(k, frame) : []),
    ...(film.has("stress") ? stressOfBlock(k, frame) : []),
    ...film.others().map(({ name, meaning, unit }) => measured(meaning, frame[name][k], unit)),
  ];
}

function velocityOfBlock(k, frame) {
  return [
    measured("Speed", Math.hypot(frame.velocity_x[k], frame.velocity_y[k]), "m/s"),
    measured("… x", frame.velocity_x[k], "m/s"),
    measured("… y", frame.velocity_y[k], "m/s"),
    measured("Angular velocity", frame.angular_velocity[k], "rad/s"),
  ];
}

function stressOfBlock(k, frame) {
  const [xx, yy, xy] = PARTS.stress.map((part) => frame[part][k]);
  const [major, minor, angle] = principal(xx, yy, xy);
  return [
    measured("Mean stress", 0.5 * (xx + yy), "Pa"),
    measured("σ1 (greatest)", major, "Pa"),
    measured("σ2 (least)", minor, "Pa"),
    measured("σ1 from x axis", angle, "rad"),
    measured("σxx", xx, "Pa"),
    measured("σyy", yy, "Pa"),
    measured("σxy", xy, "Pa"),
  ];
}

function numbersOfMonitor(film, k, frame) {
  const [x, y] = film.head.monitors[k].place,
    monitor = frame.monitors[k];
  return [
    placed("Placed at x", x),
    placed("Placed at y", y),
    measured("Displacement", Math.hypot(monitor.ux, monitor.uy), "m"),
    measured("… x", monitor.ux, "m"),
    measured("… y", monitor.uy, "m"),
    measured("Speed", Math.hypot(monitor.vx, monitor.vy), "m/s"),
    measured("… x", monitor.vx, "m/s"),
    measured("… y", monitor.vy, "m/s"),
  ];
}

// What is chosen, in a frame.
function choiceSection(film, choice, frame) {
  const axis = film.head.axis,
    when = `${axis.name} ${digits(frame.time)} ${axis.unit}`;
  const children = [];
  if (choice.block !== null) {
    children.push(
      element("p", { class: "soft" }, `At ${when}; tension is positive`),
      table(numbersOfBlock(film, choice.block, frame)),
    );
  } else if (choice.monitor !== null) {
    children.push(
      element("p", { class: "soft" }, `At ${when}`),
      table(numbersOfMonitor(film, choice.monitor, frame)),
    );
  } else {
    children.push(element("p", { class: "soft" }, "Click the rock, a joint or a monitor to see its numbers; or go there by the arrow keys with Shift."));
  }
  const { block, monitor } = choice;
  const title =
    block !== null
      ? `Block ${film.shape.blocks[block].id}`
      : monitor !== null
        ? `Monitor ${film.head.monitors[monitor].name}`
        : "Numbers";
  const made = section(title, ...children);
  made.id = "choice";
  return made;
}

// Keys of the page and what they do.
const KEYS = [
  ["Space", "play or pause"],
  ["← →", "one frame back or forward"],
  ["Home, End", "first and last moment"],
  ["+ − 0", "zoom in, zoom out, whole slope"],
  ["1 to 8", "colours"],
  ["Shift with arrows", "choose a place: block, element and joint there"],
  ["D", "light or dark"],
  ["Esc", "let go of a block or monitor"],
  ["?", "this list"],
];

// Marks beside the colour: a reader who sees no colour sees the mark.
const VERDICTS = { stable: "● stable", unstable: "✕ unstable", caught: "▲ caught" };

// A table with a head; so many columns are text.
function headed(id, texts, head, rows) {
  const cells = head.map((name, k) => element("th", k < texts ? { class: "text" } : {}, name));
  return element("table", { id }, element("thead", {}, element("tr", {}, ...cells)), element("tbody", {}, ...rows));
}

function trialsSection({ result, trials }) {
  const head = ["F", "Verdict", "Moved", "Failing"];
  const rows = trials.map((trial) =>
    element(
      "tr",
      {
        title: `${trial.reason}, after ${digits(trial.time)} s, at ${withUnit(trial.speed, "m/s")}, ${counted(trial.failing, "block")} fail`,
      },
      element("td", { class: "text" }, trial.factor.toFixed(4)),
      element("td", { class: `text ${trial.verdict}` }, VERDICTS[trial.verdict] ?? trial.verdict),
      element("td", {}, withUnit(trial.displacement, "m")),
      element("td", {}, trial.failing ? `${digits(trial.area)} m²` : "–"),
    ),
  );
  return section("Factor of safety", element("p", {}, result), headed("trials", 2, head, rows));
}

function stagesSection(stages, end) {
  const head = ["Stage", "From", "To", "End"];
  const rows = stages.map((stage) =>
    element(
      "tr",
      { "data-stage": stage.number },
      element("td", { class: "text" }, `${stage.name} (${stage.kind})`),
      element("td", {}, `${digits(stage.start)} s`),
      element("td", {}, `${digits(stage.end ?? end)} s`),
      element("td", {}, stage.outcome || "…"),
    ),
  );
  return section("Stages", headed("stages", 1, head, rows));
}

// What a run says of its slope, before all else.
function verdictSection({ text, failed }) {
  const made = section(failed ? "✕ The slope has failed" : "Verdict", element("p", {}, text));
  made.id = "verdict";
  made.className = failed ? "failed" : "";
  return made;
}

// Changes in the drawing, folded: they are many, and few readers look for one.
function changesSection(changes) {
  const count = changes.reduce((sum, note) => sum + note.count, 0);
  const tables = changes.flatMap(({ title, rows, count: all }) => [
    element("h3", {}, rows.length < all ? `${title} (first ${rows.length} of ${all})` : `${title} (${all})`),
    table(rows.map((row) => [row.name, row.value])),
  ]);
  const made = folded(`Notes on the drawing (${count})`, false, ...tables);
  made.id = "changes";
  return made;
}

function warningsSection(warnings) {
  const list = element("ul", {}, ...warnings.map(({ text }) => element("li", {}, text)));
  const made = folded(`Warnings (${warnings.length})`, true, list);
  made.className = "warnings";
  return made;
}

function markedSection({ name, blocks, rows }, k, shown, toggle) {
  const box = element("input", { type: "checkbox", checked: shown });
  box.addEventListener("change", () => toggle(k, box.checked));
  return section(
    name,
    element("label", {}, box, `Mark ${blocks.length === 1 ? "this block" : `these ${blocks.length} blocks`}`),
    table(rows.map((row) => [row.name, row.value])),
  );
}

// What a film holds beside its slope, in the order in which a reader wants it.
function panelSections(film, shown, toggle) {
  const made = [];
  film.of("trials").forEach((note) => made.push(trialsSection(note)));
  film.of("marked").forEach((note, k) => made.push(markedSection(note, k, shown[k], toggle)));
  film
    .of("facts")
    .forEach((note) => made.push(section(note.title, table(note.rows.map((row) => [row.name, row.value])))));
  const breaks = film.of("break");
  if (breaks.length) made.push(breaksSection(breaks));
  const warnings = film.of("warning"),
    stages = film.of("stage");
  if (warnings.length) made.push(warningsSection(warnings));
  if (stages.length) made.push(stagesSection(stages, film.end));
  const changes = film.of("changes");
  if (changes.length) made.push(changesSection(changes));
  return made;
}

// The case file without its folders.
function fileName(head) {
  return head.case_file.split(/[\\/]/).at(-1);
}

function caseSection(film) {
  return folded(`Case file ${fileName(film.head)}`, false, element("pre", { tabindex: "0" }, film.head.case_text));
}

// How exact the page is, in metres.
function accuracySection(film) {
  let quantum = 0;
  for (const frame of film.frames) quantum = Math.max(quantum, frame.quantum);
  return folded(
    "How exact this page is",
    false,
    element(
      "p",
      {},
      `Corners are drawn within ${withUnit(quantum / 2, "m")} of the result, in each axis. Displacements ` +
        "of blocks and all numbers of monitors and histories have 7 digits; rotations, velocities and stresses of " +
        "blocks have 4. Between two frames the picture is interpolated; numbers are those of the frame before.",
    ),
    ...(film.frames.some(({ elements }) => elements) ? [element("p", {}, exactElements(film))] : []),
  );
}

// How exact elements and joints are.
function exactElements(film) {
  const most = (name) => Math.max(...film.frames.map(({ elements }) => elements?.[name].quantum ?? 0));
  return (
    `Stresses of elements are within ${withUnit(most("stress"), "Pa")}, velocities within ` +
    `${withUnit(most("velocity"), "m/s")}, at rest closer: a probe shows it. They stand in every third frame and at ` +
    "the end of each stage; between these, how they differ from the mean of their block stays. Openings and slips of " +
    `joints are within 5 % or ${withUnit(film.shape.size / JOINT_SMALL / JOINT_STEPS, "m")}.`
  );
}
