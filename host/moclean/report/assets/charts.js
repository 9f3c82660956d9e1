// A chart over the frames of the take (dygraphs): a click seeks, a line stands at the current frame.
(function (report) {
  "use strict";

  // Fingers scroll the page; a tap seeks.
  function interaction() {
    const model = { ...Dygraph.defaultInteractionModel };
    for (const name of ["touchstart", "touchmove", "touchend"]) delete model[name];
    return model;
  }

  function themed() {
    return { axisLineColor: report.colour("line"), gridLineColor: report.colour("line") };
  }

  // rows: [frame, value...]; series: { label: { colour: name of the style sheet, ...dygraphs' } }.
  // The names stand above the chart, where they cover no curve.
  report.createChart = (element, rows, series, state, options = {}) => {
    const legend = report.element("div", { class: "legend" });
    element.before(legend);
    const names = Object.keys(series);
    const colours = () => names.map((name) => report.colour(series[name].colour));
    const graph = new Dygraph(element, rows, {
      labels: ["frame", ...names],
      colors: colours(),
      series: Object.fromEntries(names.map((name) => [name, series[name].drawing || {}])),
      interactionModel: interaction(),
      connectSeparatedPoints: false,
      legend: "always",
      labelsDiv: legend,
      labelsKMB: false,
      digitsAfterDecimal: 4,
      highlightCircleSize: 3,
      gridLineWidth: 0.5,
      axes: {
        x: { valueFormatter: (frame) => `frame ${frame}`, pixelsPerLabel: 80 },
        y: { axisLabelWidth: 46, pixelsPerLabel: 26, valueFormatter: report.number },
      },
      ...themed(),
      ...options,
      clickCallback: (event, frame) => state.seek(frame),
    });

    const cursor = report.element("div", { class: "cursor" });
    element.append(cursor);
    const place = () => {
      const x = graph.toDomXCoord(state.values.frame);
      const area = graph.getArea();
      cursor.hidden = x < area.x || x > area.x + area.w;
      cursor.style.left = `${x}px`;
    };
    graph.ready(place);
    state.listen((values, changed) => { if (changed.frame) place(); });
    report.onThemeChange(() => graph.updateOptions({ colors: colours(), ...themed() }));
    new ResizeObserver(() => { graph.resize(); place(); }).observe(element);
    return { graph, place, legend };
  };
})(window.mocleanReport);
