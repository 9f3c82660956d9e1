// Colours of the style sheet, as numbers of the page, and how figures are written.
(function (report) {
  "use strict";

  const dark = window.matchMedia("(prefers-color-scheme: dark)");

  report.colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim();
  report.isDark = () => dark.matches;
  report.onThemeChange = (listener) => dark.addEventListener("change", listener);

  // Four digits that count; tiny and huge figures with an exponent.
  report.number = (value) => {
    if (value === null || Number.isNaN(value)) return "–";
    if (value === 0 || Number.isInteger(value) && Math.abs(value) < 1e7) return String(value);
    const size = Math.abs(value);
    if (size < 1e-3 || size >= 1e6) return value.toExponential(2);
    return value.toPrecision(size < 1 ? 3 : 4).replace(/(\.\d*?)0+$/, "$1").replace(/\.$/, "");
  };

  // element("button", { type: "button" }, "text" or other elements)
  report.element = (name, attributes = {}, ...children) => {
    const node = document.createElement(name);
    for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
    node.append(...children);
    return node;
  };

  report.byId = (id) => document.getElementById(id);
})(window.mocleanReport);
