// Colours, scales and numbers with units.

// Viridis (S. van der Walt and N. Smith, matplotlib, CC0) and cividis (J. Nuñez, C. Anderton and R. Renslow, 2018), at
// equal steps: both grow evenly in lightness, also for readers to whom red and green look alike.
const VIRIDIS = [
  "440154",
  "481a6c",
  "472f7d",
  "414487",
  "39568c",
  "31688e",
  "2a788e",
  "23888e",
  "1f988b",
  "22a884",
  "35b779",
  "54c568",
  "7ad151",
  "a5db36",
  "d2e21b",
  "fde725",
];
const CIVIDIS = [
  "00224e",
  "002f6d",
  "213d6e",
  "374a6c",
  "48586d",
  "57656d",
  "66736f",
  "747f73",
  "828d76",
  "919a77",
  "a19f75",
  "b2a96f",
  "c3b567",
  "d5c25a",
  "e8d048",
  "fee838",
];
// M. Okabe and K. Ito, Color Universal Design, 2008.
const OKABE_ITO = ["#e69f00", "#56b4e9", "#009e73", "#f0e442", "#0072b2", "#d55e00", "#cc79a7", "#999999"];
const STEPS = 48;
// Softer ones for blocks, so that outlines and marks show on them.
const BLOCK_FILLS = OKABE_ITO.map((colour) => whiter(rgb(colour.slice(1)), 0.4));

// How joints are drawn: the colour, the width and the dashes each show the state alone.
function jointStyle(state, theme) {
  if (state === LOCK) return { name: "locked", colour: OKABE_ITO[theme.dark ? 1 : 4], width: 1.6, dash: [] };
  if (state === SLIP) return { name: "slipping", colour: OKABE_ITO[5], width: 4, dash: [] };
  if (state === BRIDGE) return { name: "bridge that holds", colour: OKABE_ITO[2], width: 5, dash: [] };
  if (state === BROKEN_BRIDGE) return { name: "broken bridge", colour: OKABE_ITO[0], width: 5, dash: [2, 3] };
  return { name: "open", colour: OKABE_ITO[6], width: 2.2, dash: [5, 4] };
}

function rgb(hex) {
  return [0, 2, 4].map((k) => parseInt(hex.slice(k, k + 2), 16));
}

// A part of white in all colours, so that dark outlines show on the dark end.
const WHITE = 0.14;

// A colour of CSS with a part of white in it.
function whiter(channels, part) {
  return `rgb(${channels.map((channel) => Math.round(channel + (255 - channel) * part)).join(" ")})`;
}

// The steps of a map as colours of CSS.
function ramp(map) {
  return Array.from({ length: STEPS }, (_, step) => {
    const place = (step / (STEPS - 1)) * (map.length - 1),
      below = Math.min(Math.floor(place), map.length - 2);
    const [from, to] = [rgb(map[below]), rgb(map[below + 1])];
    const mixed = from.map((channel, k) => channel + (to[k] - channel) * (place - below));
    return whiter(mixed, WHITE);
  });
}

const RAMPS = { viridis: ramp(VIRIDIS), cividis: ramp(CIVIDIS) };

// What blocks can be coloured by. `value` is of block k in a frame, relative to frame `base` when one is given.
const COLOURS = [
  {
    key: "displacement",
    name: "Displacement",
    ramp: "viridis",
    unit: "m",
    logarithmic: true,
    value: (frame, k, base) =>
      Math.hypot(
        frame.displacement_x[k] - (base ? base.displacement_x[k] : 0),
        frame.displacement_y[k] - (base ? base.displacement_y[k] : 0),
      ),
  },
  {
    key: "velocity",
    name: "Velocity",
    ramp: "viridis",
    unit: "m/s",
    logarithmic: true,
    value: (frame, k) => Math.hypot(frame.velocity_x[k], frame.velocity_y[k]),
  },
  {
    key: "stress",
    name: "Mean stress",
    ramp: "cividis",
    unit: "Pa",
    logarithmic: false,
    value: (frame, k) => 0.5 * (frame.mean_stress_xx[k] + frame.mean_stress_yy[k]),
  },
  {
    key: "shear",
    name: "Greatest shear stress",
    ramp: "viridis",
    unit: "Pa",
    logarithmic: false,
    value: (frame, k) =>
      Math.hypot(0.5 * (frame.mean_stress_xx[k] - frame.mean_stress_yy[k]), frame.mean_stress_xy[k]),
  },
  { key: "block", name: "Block" },
  { key: "joint", name: "Joint state" },
  { key: "slip", name: "Joint slip", ramp: "viridis", unit: "m", logarithmic: true, ofJoints: true },
  { key: "opening", name: "Joint opening", ramp: "viridis", unit: "m", logarithmic: true, ofJoints: true },
];

// What a film has to colour by; a model as it is built has not moved. Keys of the keyboard are places in `COLOURS`.
function coloursOf(film) {
  const has = {
    displacement: film.head.command !== "edit",
    velocity: film.has("velocity"),
    stress: film.has("stress"),
    shear: film.has("stress"),
    block: true,
    joint: film.frames.some((frame) => frame.edges?.some(Boolean)),
    slip: film.hasJoints(),
    opening: film.hasJoints(),
  };
  return [...COLOURS.filter(({ key }) => has[key]), ...film.others().map(colourOf)];
}

// A number of blocks as a colour.
function colourOf({ name, meaning, unit, range }) {
  const value = (frame, k) => frame[name][k];
  return { key: name, name: meaning, ramp: "viridis", unit, range, logarithmic: false, value };
}

// Smallest to largest value of a quantity over frames; one block in two hundred at either end does not count when
// there are many, so that a single chip does not take all colours.
function rangeOf(film, colour, frames, base) {
  if (colour.range) return colour.range;
  if (colour.ofJoints) {
    const of = (frame) => frame.elements && numbersOfJoints(frame, colour.key);
    return rangeOfParts(frames, of, true);
  }
  if (OF_ELEMENTS[colour.key] && frames.some((frame) => frame.elements)) {
    const of = (frame) => numbersOfElements(frame, colour.key, film.under(base, frame.shape));
    return rangeOfParts(frames, of, colour.logarithmic);
  }
  const values = [];
  for (const frame of frames) {
    const from = film.under(base, frame.shape);
    for (let k = 0; k < frame.shape.count; k++) if (!frame.removed[k]) values.push(colour.value(frame, k, from));
  }
  if (!values.length) return [0, 1];
  const sorted = Float64Array.from(values).sort(),
    cut = Math.floor(sorted.length / 200);
  const low = colour.logarithmic ? 0 : sorted[cut],
    high = sorted[sorted.length - 1 - (colour.logarithmic ? 0 : cut)];
  return high > low ? [low, high] : [low, low + (Math.abs(low) || 1)];
}

// The step of the scale for a value; three decades when it is logarithmic.
function stepOf(value, [low, high], logarithmic) {
  const part = logarithmic ? 1 + Math.log10(Math.max(value, 1e-300) / high) / 3 : (value - low) / (high - low);
  return Math.max(0, Math.min(STEPS - 1, Math.floor(part * STEPS)));
}

// Unit of display for values up to `size`, with its weight in the SI unit.
function unitFor(unit, size) {
  const scales = {
    m: [
      ["mm", 1e-3, 1],
      ["m", 1, Infinity],
    ],
    "m/s": [
      ["mm/s", 1e-3, 0.1],
      ["m/s", 1, Infinity],
    ],
    Pa: [
      ["Pa", 1, 1e3],
      ["kPa", 1e3, 1e6],
      ["MPa", 1e6, Infinity],
    ],
    "N/m": [
      ["N/m", 1, 1e3],
      ["kN/m", 1e3, 1e6],
      ["MN/m", 1e6, Infinity],
    ],
    N: [
      ["N", 1, 1e3],
      ["kN", 1e3, 1e6],
      ["MN", 1e6, Infinity],
    ],
    "J/m": [
      ["J/m", 1, 1e3],
      ["kJ/m", 1e3, 1e6],
      ["MJ/m", 1e6, Infinity],
    ],
    "kg/m": [
      ["kg/m", 1, 1e3],
      ["t/m", 1e3, Infinity],
    ],
    rad: [["°", Math.PI / 180, Infinity]],
    "rad/s": [["°/s", Math.PI / 180, Infinity]],
  };
  const found = (scales[unit] ?? []).find(([, , limit]) => Math.abs(size) < limit);
  return found ? { name: found[0], weight: found[1] } : { name: unit, weight: 1 };
}

// Four digits, and powers of ten only for the very large and the very small.
function digits(value) {
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size >= 1e6 || size < 1e-4) return value.toExponential(3);
  return size >= 1000 ? value.toFixed(0) : value.toPrecision(4);
}

function counted(count, what) {
  return `${count} ${what}${count === 1 ? "" : "s"}`;
}

function withUnit(value, unit) {
  const shown = unitFor(unit, value);
  return `${digits(value / shown.weight)}${shown.name === "°" || !shown.name ? "" : " "}${shown.name}`.replace(
    "-",
    "−",
  );
}
