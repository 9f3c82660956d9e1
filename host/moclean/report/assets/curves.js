// The channels of the picked joint over the frames: noisy, clean, truth, corrected entries as dots.
(function (report) {
  "use strict";

  const { byId, element } = report;

  const drawings = {
    noisy: { strokeWidth: 0.8 },
    mark: { strokeWidth: 0, drawPoints: true, pointSize: 1.6 },
    truth: { strokeWidth: 2.6 },
    clean: { strokeWidth: 1.3 },
  };

  // [frame, noisy, noisy again where it was corrected, truth if there is one, clean]: what comes later
  // is drawn over what was before. null breaks a line.
  function rowsOf(take, column) {
    const rows = [];
    for (let frame = 0; frame < take.frames; ++frame) {
      const values = take.clips.map((clip) => {
        const value = clip.samples.value(frame, column);
        return Number.isNaN(value) ? null : value;
      });
      const [noisy, clean, ...truth] = values;
      rows.push([frame, noisy, take.isMarked(frame, column) ? noisy : null, ...truth, clean]);
    }
    return rows;
  }

  function seriesOf(take) {
    const keys = take.clip("truth") ? ["noisy", "mark", "truth", "clean"] : ["noisy", "mark", "clean"];
    const name = (key) => key === "mark" ? "corrected" : key;
    return Object.fromEntries(keys.map((key) => [name(key), { colour: key, drawing: drawings[key] }]));
  }

  const titleOf = (take, joint, index) => take.joints[joint].columns === 3 ? "xyz"[index] : "";

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
    byId("threshold").textContent = report.number(take.figures.threshold) + (take.unit ? ` ${take.unit}` : "");
    const curves = new Curves(take, state);
    byId("whole").addEventListener("click", () => curves.zoom(null));
    state.listen((values, changed) => {
      if (!changed.joint) return;
      choice.value = String(values.joint);
      curves.show(values.joint);
    });
  };
})(window.mocleanReport);
