// Histories on a canvas whose time axis is that of the slider under it.

const INSET = 8; // Half the thumb of the slider: its ends are there.
const STAGE_ROWS = [10, 22, 34]; // Base lines of the names of stages.
const DASHES = [[], [6, 3], [2, 3]];

// A number of the series 1, 2, 5, 10 … that is not below `least`.
function roundUp(least) {
  const power = 10 ** Math.floor(Math.log10(least));
  return [1, 2, 5, 10].map((k) => k * power).find((value) => value >= least * (1 - 1e-9));
}

// Charts that a film offers: columns of one quantity and unit together.
function chartsOf(film) {
  const charts = new Map();
  film.head.columns.forEach((column, k) => {
    // The time is the axis, and stages are lines in every chart.
    if (k === 0 || column.quantity === "Stage" || !film.rows.time.length) return;
    const name = column.unit ? `${column.quantity} (${column.unit})` : column.quantity;
    if (!charts.has(name)) charts.set(name, { name, unit: column.unit, series: [] });
    const values = film.rows.columns[k];
    if (values.some((value) => value !== 0))
      charts.get(name).series.push({ name: column.name, time: film.rows.time, values });
  });
  return [...charts.values()].filter((chart) => chart.series.length);
}

// Charts of one block over the frames.
function chartsOfBlock(film, k) {
  if (k === null) return [];
  const time = film.frames.map((frame) => frame.time),
    block = film.shape.blocks[k];
  const over = (of) => film.frames.map((frame) => of(frame, placesIn(film.shape, frame.shape)[k]));
  const chart = (name, unit, parts) => ({
    name: `Block ${block.id}: ${name} (${unit})`,
    unit,
    series: parts.map(([part, of]) => ({ name: part, time, values: over(of) })),
  });
  const charts = [
    chart("displacement", "m", [
      ["ux", (f, k) => f.displacement_x[k]],
      ["uy", (f, k) => f.displacement_y[k]],
    ]),
  ];
  if (film.has("velocity")) {
    charts.push(
      chart("velocity", "m/s", [
        ["vx", (f, k) => f.velocity_x[k]],
        ["vy", (f, k) => f.velocity_y[k]],
      ]),
    );
  }
  if (film.has("stress")) {
    charts.push(
      chart("stress", "Pa", [
        ["σxx", (f, k) => f.mean_stress_xx[k]],
        ["σyy", (f, k) => f.mean_stress_yy[k]],
        ["σxy", (f, k) => f.mean_stress_xy[k]],
      ]),
    );
  }
  for (const { name, meaning, unit } of film.others()) charts.push(chart(meaning, unit, [[name, (f, k) => f[name][k]]]));
  return charts;
}

class Chart {
  constructor(canvas) {
    this.canvas = canvas;
    this.pen = canvas.getContext("2d");
    this.chart = null;
    this.range = [0, 1];
  }

  show(chart) {
    this.chart = chart;
    let [low, high] = [0, 0];
    for (const series of chart?.series ?? [])
      for (const value of series.values) {
        if (value < low) low = value;
        if (value > high) high = value;
      }
    const step = roundUp((high - low) / 3 || 1);
    this.step = step;
    this.range = [Math.floor(low / step) * step, Math.ceil(high / step) * step || step];
  }

  timeAt(px, [start, end]) {
    const part = (px - INSET) / (this.canvas.clientWidth - 2 * INSET);
    return start + Math.max(0, Math.min(1, part)) * (end - start);
  }

  draw(time, span, stages, theme) {
    const { pen, canvas } = this,
      ratio = window.devicePixelRatio || 1;
    const { clientWidth: width, clientHeight: height } = canvas;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      [canvas.width, canvas.height] = [Math.round(width * ratio), Math.round(height * ratio)];
    }
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.clearRect(0, 0, width, height);
    pen.font = "11px system-ui, sans-serif";
    const x = (t) => INSET + ((t - span[0]) / (span[1] - span[0] || 1)) * (width - 2 * INSET);
    const y = (value) => height - 5 - ((value - this.range[0]) / (this.range[1] - this.range[0])) * (height - 24);
    this.drawGrid(width, x, y, theme);
    this.drawStages(stages, x, height, theme);
    (this.chart?.series ?? []).forEach((series, k) => this.drawSeries(series, seriesStyle(k, theme), x, y));
    pen.strokeStyle = theme.accent;
    pen.lineWidth = 1.5;
    pen.beginPath();
    pen.moveTo(x(time), 14);
    pen.lineTo(x(time), height);
    pen.stroke();
  }

  drawGrid(width, x, y, theme) {
    if (!this.chart) return;
    const { pen } = this,
      [low, high] = this.range,
      shown = unitFor(this.chart.unit, Math.max(-low, high));
    for (let k = 0; low + k * this.step <= high + 0.01 * this.step; k++) {
      const value = low + k * this.step;
      pen.strokeStyle = theme.line;
      pen.lineWidth = 1;
      pen.beginPath();
      pen.moveTo(INSET, Math.round(y(value)) + 0.5);
      pen.lineTo(width - INSET, Math.round(y(value)) + 0.5);
      pen.stroke();
      const label = `${Number((value / shown.weight).toPrecision(6))}${value === 0 ? "" : ` ${shown.name}`}`.replace(
        "-",
        "−",
      );
      this.write(label, width - INSET - 3, y(value) - 2, theme, "right");
    }
  }

  drawStages(stages, x, height, theme) {
    const { pen } = this,
      ends = STAGE_ROWS.map(() => -Infinity);
    for (const stage of stages) {
      pen.strokeStyle = theme.soft;
      pen.lineWidth = 1;
      pen.setLineDash([3, 3]);
      pen.beginPath();
      pen.moveTo(Math.round(x(stage.start)) + 0.5, 0);
      pen.lineTo(Math.round(x(stage.start)) + 0.5, height);
      pen.stroke();
      pen.setLineDash([]);
      // Names that would overlap stand in rows; one without room is left to the table of stages.
      const left = x(stage.start) + 4,
        row = ends.findIndex((end) => end < left);
      if (row < 0) continue;
      ends[row] = left + pen.measureText(stage.name).width + 6;
      this.write(stage.name, left, STAGE_ROWS[row], theme);
    }
  }

  write(text, x, y, theme, align = "left") {
    this.pen.textAlign = align;
    this.pen.lineWidth = 3;
    this.pen.strokeStyle = theme.paper;
    this.pen.strokeText(text, x, y);
    this.pen.fillStyle = theme.soft;
    this.pen.fillText(text, x, y);
  }

  drawSeries({ time, values }, style, x, y) {
    const { pen } = this;
    pen.strokeStyle = style.colour;
    pen.setLineDash(style.dash);
    pen.lineWidth = 1.7;
    pen.beginPath();
    for (let i = 0; i < time.length; i++) pen.lineTo(x(time[i]), y(values[i]));
    pen.stroke();
    pen.setLineDash([]);
  }
}

// Colour and dashes of a series; dashes change when the colours begin again. What is lost on the paper is left out.
function seriesStyle(k, theme) {
  const colours = (theme.dark ? [1, 0, 2, 6, 3, 5, 7] : [4, 5, 2, 0, 6, 1, 7]).map((place) => OKABE_ITO[place]);
  return { colour: colours[k % colours.length], dash: DASHES[Math.floor(k / colours.length) % DASHES.length] };
}
