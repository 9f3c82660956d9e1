// Segments, results and parameters.
(function (report) {
  "use strict";

  const { byId, element, number } = report;

  function cellOf(value) {
    const isText = typeof value === "string";
    return element("td", isText ? {} : { class: "number" }, isText ? value : number(value));
  }

  // Missing figures stay below whichever way a column is sorted.
  function compare(a, b, direction) {
    if (a === null || b === null) return (a === null) - (b === null);
    const isText = typeof a === "string" || typeof b === "string";
    return direction * (isText ? String(a).localeCompare(String(b)) : a - b);
  }

  // A click on a head sorts by its column, another the other way round.
  function tableOf(columns, rows, rowOf) {
    const body = element("tbody");
    const fill = () => body.replaceChildren(...rows.map(rowOf));
    let sorted = { column: -1, direction: 1 };
    const heads = columns.map((name, column) => {
      const isNumber = rows.some((row) => typeof row[column] === "number");
      const button = element("button", { type: "button" }, name);
      const head = element("th", { scope: "col", class: isNumber ? "number" : "" }, button);
      button.addEventListener("click", () => {
        sorted = { column, direction: sorted.column === column ? -sorted.direction : 1 };
        rows.sort((a, b) => compare(a[column], b[column], sorted.direction));
        for (const other of heads) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", sorted.direction > 0 ? "ascending" : "descending");
        fill();
      });
      return head;
    });
    fill();
    return element("table", {}, element("thead", {}, element("tr", {}, ...heads)), body);
  }

  const plainRow = (row) => element("tr", {}, ...row.map(cellOf));

  report.showSegments = (take, state) => {
    byId("segments").hidden = take.segments.length === 0;
    const columns = ["first frame", "frames", "iterations", "rank", "residual", "converged"];
    // null: the method has no such thing
    const rows = take.segments.map((segment) => [segment.first, segment.frames, segment.iterations, segment.rank ?? "-",
                                                 segment.residual ?? "-",
                                                 segment.converged === null ? "-" : segment.converged ? "yes" : "no"]);
    const rowOf = (row) => {
      const line = plainRow(row);
      if (row[5] === "no") line.className = "bad";
      const go = element("button", { type: "button", title: "go to this segment" }, String(row[0]));
      go.addEventListener("click", () => state.seek(row[0]));
      line.firstChild.replaceChildren(go);
      return line;
    };
    byId("segments").querySelector(".scroll").append(tableOf(columns, rows, rowOf));
  };

  report.showTables = (tables) => {
    for (const table of tables) {
      const section = element("section", { "aria-label": table.title }, element("h2", {}, table.title));
      if (table.note) section.append(element("p", { class: "hint" }, table.note));
      section.append(element("div", { class: "scroll" }, tableOf(table.columns, table.rows, plainRow)));
      byId("tables").append(section);
    }
  };

  report.showParameters = (parameters) => {
    byId("parameters").hidden = parameters.length === 0;
    const lines = parameters.map(([name, value]) => element("tr", {}, element("th", { scope: "row" }, name),
                                                            element("td", {}, value)));
    byId("parameters").querySelector(".scroll").append(element("table", {}, element("tbody", {}, ...lines)));
  };
})(window.mocleanReport);
