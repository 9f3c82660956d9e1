// The channels of the picked joint over the frames: noisy, clean, truth, corrected and filled entries as dots, twice
// the standard deviation of the clean one as a band.
(function (report) {
  "use strict";

  const { byId, element } = report;

  const drawings = {
    noisy: { strokeWidth: 0.8 },
    mark: { strokeWidth: 0, drawPoints: true, pointSize: 1.6 },
    filled: { strokeWidth: 0, drawPoints: true, pointSize: 1.6 },
    truth: { strokeWidth: 2.6 },
    clean: { strokeWidth: 1.3 },
  };

  // [frame, noisy, noisy again where it was corrected, truth if there is one, clean, clean again where it was filled]:
  // what comes later is drawn over what was before. null breaks a line.
  function rowsOf(take, column) {
    const rows = [];
    for (let frame = 0; frame < take.frames; ++frame) {
      const values = take.clips.map((clip) => {
        const value = clip.samples.value(frame, column);
        return Number.isNaN(value) ? null : value;
      });
      const [noisy, clean, ...truth] = values;
      rows.push([frame, noisy, take.isMarked(frame, column) ? noisy : null, ...truth, clean,
                 take.isFilled(frame, column) ? clean : null]);
    }
    return rows;
  }

  function seriesOf(take) {
    const keys = ["noisy", "mark", ...(take.clip("truth") ? ["truth"] : []), "clean", "filled"];
    const name = (key) => key === "mark" ? "corrected" : key;
    return Object.fromEntries(keys.map((key) => [name(key), { colour: key, drawing: drawings[key] }]));
  }

  // Clean -+ 2 sigma, behind the curves: a piece for every run of frames that have both.
  function drawBand(take, column, pen, graph) {
    if (!take.sigma) return;
    const clean = take.clip("clean").samples;
    const [from, to] = graph.xAxisRange();
    const first = Math.max(0, Math.floor(from));
    const last = Math.min(take.frames - 1, Math.ceil(to));
    let piece = [];
    const close = () => {
      if (piece.length > 0) {
        pen.beginPath();
        for (const [x, upper] of piece) pen.lineTo(x, upper);
        for (const [x, , lower] of piece.reverse()) pen.lineTo(x, lower);
        pen.fill();
      }
      piece = [];
    };
    pen.save();
    pen.globalAlpha = 0.25;
    pen.fillStyle = report.colour("clean");
    for (let frame = first; frame <= last; ++frame) {
      const middle = clean.value(frame, column);
      const reach = 2 * take.sigma.value(frame, column);
      if (Number.isNaN(middle + reach)) close();
      else piece.push([graph.toDomXCoord(frame), graph.toDomYCoord(middle + reach), graph.toDomYCoord(middle - reach)]);
    }
    close();
    pen.restore();
  }

  const titleOf = (take, joint, index) => take.joints[joint].columns > 1 ? "xyz"[index] : "";

  class Curves {
    constructor(take, state) {
      Object.assign(this, { take, state, charts: [] });
      this.show(state.values.joint);
    }

    show(joint) {
      const { first, columns } = this.take.joints[joint];
      if (this.charts.length !== columns) this.create(joint, columns);
      this.charts.forEach((chart, i) => {
        chart.graph.updateOptions({ file: rowsOf(this.take, first + i), ylabel: titleOf(this.take, joint, i) });
        chart.place();
      });
      byId("charts").dataset.joint = this.take.joints[joint].name;
    }

    create(joint, columns) {
      for (const chart of this.charts) chart.graph.destroy();
      byId("charts").replaceChildren();
      this.charts = [];
      for (let i = 0; i < columns; ++i) {
        const box = element("div", { class: "chart" });
        byId("charts").append(box);
        const rows = rowsOf(this.take, this.take.joints[joint].first + i);
        this.charts.push(report.createChart(box, rows, seriesOf(this.take), this.state, {
          ylabel: titleOf(this.take, joint, i),
          underlayCallback: (pen, area, graph) =>
            drawBand(this.take, this.take.joints[this.state.values.joint].first + i, pen, graph),
          zoomCallback: (from, to) => this.zoom([from, to]),
        }));
      }
    }

    // All channels show the same frames.
    zoom(window) {
      for (const chart of this.charts) {
        chart.graph.updateOptions({ dateWindow: window, valueRange: null });
        chart.place();
      }
    }
  }

  report.showCurves = (take, state) => {
    const choice = byId("joint");
    take.joints.forEach((joint, index) => choice.append(element("option", { value: index }, joint.name)));
    choice.value = String(state.values.joint);
    choice.addEventListener("change", () => state.set({ joint: Number(choice.value) }));
    byId("unit").textContent = take.unit;
    if (take.figures.threshold > 0)
      byId("threshold").textContent =
        ` by more than ${report.number(take.figures.threshold)}${take.unit ? ` ${take.unit}` : ""}`;
    byId("band").hidden = take.sigma === null;
    const curves = new Curves(take, state);
    byId("whole").addEventListener("click", () => curves.zoom(null));
    state.listen((values, changed) => {
      if (!changed.joint) return;
      choice.value = String(values.joint);
      curves.show(values.joint);
    });
  };
})(window.mocleanReport);
