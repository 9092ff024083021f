/* made by hand for taylor-verify publish --site: motions in space, drawn by Plotly when they come into view */
"use strict";

(function () {
  const PARALLELS = 25, MERIDIANS = 49;
  let library = null;

  // A page that is opened as a file cannot fetch other files, but it can load a script.
  function plotly() {
    library = library || new Promise(function (done, failed) {
      const script = document.createElement("script");
      script.src = document.documentElement.dataset.content_root + "_static/plotly.min.js";
      script.onload = function () { done(window.Plotly); };
      script.onerror = failed;
      document.head.append(script);
    });
    return library;
  }

  // "$low" is a colour of the theme.
  function coloured(value, style) {
    if (typeof value === "string" && value[0] === "$") {
      return style.getPropertyValue("--motion-" + value.slice(1)).trim();
    }
    if (Array.isArray(value)) return value.map(function (part) { return coloured(part, style); });
    if (value === null || typeof value !== "object") return value;
    return Object.fromEntries(Object.entries(value).map(function (pair) {
      return [pair[0], coloured(pair[1], style)];
    }));
  }

  // The net of an ellipsoid, its semi-axes along the rows of `axes`.
  function withNet(trace) {
    if (!trace.ball) return trace;
    const net = [[], [], []];
    for (let i = 0; i < PARALLELS; i++) {
      const polar = Math.PI * i / (PARALLELS - 1);
      const lines = [[], [], []];
      for (let k = 0; k < MERIDIANS; k++) {
        const turn = 2 * Math.PI * k / (MERIDIANS - 1);
        const own = [Math.sin(polar) * Math.cos(turn), Math.sin(polar) * Math.sin(turn), Math.cos(polar)];
        for (let j = 0; j < 3; j++) {
          lines[j].push(own.reduce(function (sum, v, n) {
            return sum + v * trace.ball.semi[n] * trace.ball.axes[n][j];
          }, 0));
        }
      }
      for (let j = 0; j < 3; j++) net[j].push(lines[j]);
    }
    return Object.assign({}, trace, { ball: undefined, x: net[0], y: net[1], z: net[2] });
  }

  // All axes have one scale, and the diagonal of the box is as long as that of the unit cube. So the whole box is
  // in the frame, whatever its sides and the view. In a narrow frame titles and numbers take a larger part.
  function layout(titles, box, narrow) {
    const far = narrow ? 1.65 : 1.15, ticks = narrow ? 3 : 5;
    const sides = box.map(function (ends) { return ends[1] - ends[0]; }), longest = Math.max.apply(null, sides);
    const unit = Math.hypot.apply(null, sides) / Math.sqrt(3);
    const scene = {
      aspectmode: "manual",
      aspectratio: { x: sides[0] / unit, y: sides[1] / unit, z: sides[2] / unit },
      camera: { eye: { x: 1.75 * far, y: 1.75 * far, z: 1.15 * far }, center: { x: 0, y: 0, z: -0.14 } },
    };
    titles.forEach(function (title, i) {
      scene["xyz"[i] + "axis"] = {
        title: { text: title }, range: box[i], nticks: Math.max(2, Math.round(ticks * sides[i] / longest)), color: "$ink", gridcolor: "$faint", linecolor: "$quiet",
        zeroline: false, exponentformat: "power", showspikes: false, showbackground: false,
      };
    });
    return {
      paper_bgcolor: "rgba(0,0,0,0)", margin: { l: 0, r: 0, t: 8, b: 8 }, scene: scene,
      font: { family: getComputedStyle(document.body).fontFamily, size: 12, color: "$ink" },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: "$quiet", activecolor: "$ink" },
    };
  }

  async function draw(plot) {
    const stored = JSON.parse(plot.closest("figure").querySelector("script").textContent);
    const narrow = plot.clientWidth < 560;
    const drawing = await plotly();
    const style = getComputedStyle(document.body);
    await drawing.react(
      plot,
      coloured(stored.traces.map(withNet), style),
      coloured(layout(stored.axes, stored.box, narrow), style),
      { responsive: true, displaylogo: false, displayModeBar: narrow ? false : "hover" },
    );
    plot.dataset.drawn = style.getPropertyValue("--motion-ink").trim();
  }

  function tryToDraw(plot) {
    draw(plot).catch(function (reason) {
      plot.textContent = "This picture could not be drawn: " + (reason.message || "the script is missing") + ".";
    });
  }

  function begin(plots) {
    const watch = new IntersectionObserver(function (entries) {
      entries.filter(function (entry) { return entry.isIntersecting; }).forEach(function (entry) {
        watch.unobserve(entry.target);
        tryToDraw(entry.target);
      });
    }, { rootMargin: "300px" });
    plots.forEach(function (plot) { watch.observe(plot); });
    function again() {
      plots.filter(function (plot) { return plot.dataset.drawn !== undefined; }).forEach(tryToDraw);
    }
    new MutationObserver(again).observe(document.body, { attributeFilter: ["data-theme"] });
    window.matchMedia("(prefers-color-scheme: dark)").addEventListener("change", again);
    // A print shows all pictures, also those that were never scrolled into view.
    window.addEventListener("beforeprint", function () { plots.forEach(tryToDraw); });
  }

  document.addEventListener("DOMContentLoaded", function () {
    const plots = Array.from(document.querySelectorAll(".plot"));
    if (plots.length) begin(plots);
  });
})();
