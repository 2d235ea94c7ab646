// Blocks that have broken. A page has this script when its film tells of some.

const BREAKS_STYLE = `
  #breaks th { overflow-wrap: normal }
  #breaks td { padding: 0.3rem 0 0 0 }
  #breaks td.text { padding-right: 0.5rem; white-space: nowrap }
  #breaks button { white-space: nowrap; padding: 0.05rem 0.4rem; min-height: 0 }
  #breaks .forces td { padding: 0 0 0.3rem; border-bottom: 1px solid var(--line); color: var(--soft) }
  #breaks .forces td { text-align: left; font-size: 0.85rem }`;

// Shows the first frame in which a break of a time has happened.
function goToBreak(at) {
  const { film, player } = window.enmm;
  player.seek(film.frames.find(({ time }) => time >= at)?.time ?? at);
}

// Two rows of a break: what broke when and how, and what its section carried.
function rowsOfBreak({ at, block, part, failure, ends, share, normal, shear, moment }) {
  const go = element("button", { type: "button", title: "Go to this moment" }, `${digits(at)} s`);
  go.addEventListener("click", () => goToBreak(at));
  const place = ([x, y]) => `(${x.toFixed(2)}, ${y.toFixed(2)})`.replaceAll("-", "−");
  const where = `${place(ends[0])} to ${place(ends[1])} m`,
    carried = `N ${withUnit(normal, "N/m")}, V ${withUnit(shear, "N/m")}, M ${withUnit(moment, "N")}`;
  return [
    element(
      "tr",
      {},
      element("td", { class: "text" }, go),
      element("td", { class: "text" }, String(block)),
      element("td", { class: "text" }, failure),
      element("td", {}, share.toFixed(3)),
    ),
    element(
      "tr",
      { class: "forces" },
      element("td", { colspan: 4 }, `${where}: ${carried}. Block ${part} parts off.`),
    ),
  ];
}

function breaksSection(breaks) {
  return section(
    `Breaks (${breaks.length})`,
    element("style", {}, BREAKS_STYLE),
    element("p", { class: "soft" }, "Share of its strength that a section had, and what it carried: N normal, tension positive, V shear, M bending."),
    headed("breaks", 3, ["Time", "Block", "Broke", "Share"], breaks.flatMap(rowsOfBreak)),
  );
}
