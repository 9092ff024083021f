/* made by hand for taylor-verify publish --site: pictures, drawn by Plotly when they come into view */
"use strict";

(function () {
  const root = document.body.dataset.root;
  const PARALLELS = 25, MERIDIANS = 49;
  let library = null;

  function colours() {
    const dark = document.documentElement.dataset.theme
      ? document.documentElement.dataset.theme === "dark"
      : window.matchMedia("(prefers-color-scheme: dark)").matches;
    return window.sitePalette[dark ? "dark" : "light"];
  }

  // A file that is opened as a file cannot fetch another one, but it can ask for a script.
  function plotly() {
    library = library || new Promise(function (done, failed) {
      const script = document.createElement("script");
      script.src = root + "assets/plotly.min.js";
      script.onload = function () { done(window.Plotly); };
      script.onerror = failed;
      document.head.append(script);
    });
    return library;
  }

  // "$f64" is a colour of the theme, "@t" a column that several traces share, decades are hundredths of log10.
  function filled(value, columns, found) {
    if (typeof value === "string" && value[0] === "$" && value.slice(1) in found) return found[value.slice(1)];
    if (typeof value === "string" && value[0] === "@" && value.slice(1) in columns) {
      return filled(columns[value.slice(1)], columns, found);
    }
    if (Array.isArray(value)) return value.map(function (one) { return filled(one, columns, found); });
    if (value === null || typeof value !== "object") return value;
    if (value.decades) return value.decades.map(function (one) { return one === null ? null : 10 ** (one / 100); });
    const made = {};
    Object.keys(value).forEach(function (key) { made[key] = filled(value[key], columns, found); });
    if (made.base) return Object.assign({}, made.base, made, { base: undefined });
    return made.ball ? withNet(made) : made;
  }

  // The net of an ellipsoid, its semi-axes along the rows of `axes`.
  function withNet(trace) {
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
    delete trace.ball;
    return Object.assign(trace, { x: net[0], y: net[1], z: net[2] });
  }

  function joined(one, other) {
    const made = Object.assign({}, one);
    Object.keys(other || {}).forEach(function (key) {
      const both = made[key] && typeof made[key] === "object" && !Array.isArray(made[key]);
      made[key] = both && !Array.isArray(other[key]) ? joined(made[key], other[key]) : other[key];
    });
    return made;
  }

  function axis() {
    return {
      color: "$ink", gridcolor: "$faint", linecolor: "$quiet", zeroline: false, automargin: true,
      exponentformat: "power", ticks: "outside", tickcolor: "$quiet", ticklen: 4, title: { standoff: 8 },
    };
  }

  function ground(narrow) {
    const space = Object.assign(axis(), {
      backgroundcolor: "rgba(0,0,0,0)", showspikes: false, showbackground: false, ticks: "",
    });
    return {
      paper_bgcolor: "rgba(0,0,0,0)", plot_bgcolor: "rgba(0,0,0,0)",
      font: { family: getComputedStyle(document.querySelector("footer")).fontFamily, size: 12, color: "$ink" },
      margin: { l: 56, r: 12, t: 28, b: 48 },
      modebar: { bgcolor: "rgba(0,0,0,0)", color: "$quiet", activecolor: "$ink" },
      hoverlabel: { font: { size: 12 } },
      legend: narrow
        ? { orientation: "h", yanchor: "top", y: -0.22, x: 0, font: { size: 11 } }
        : { font: { size: 11 }, tracegroupgap: 0 },
      xaxis: axis(), yaxis: axis(), xaxis2: axis(), yaxis2: axis(),
      scene: {
        xaxis: space, yaxis: space, zaxis: space, camera: { eye: { x: 1.75, y: 1.75, z: 1.15 }, center: { x: 0, y: 0, z: -0.14 } },
      },
    };
  }

  // Only the axes that the picture has: a second pair would be drawn empty.
  function layoutOf(document_, drawing, narrow) {
    const own = joined(document_.layout, drawing.layout);
    const layout = joined(ground(narrow), own);
    if (!own.xaxis2) delete layout.xaxis2;
    if (!own.yaxis2) delete layout.yaxis2;
    if (own.scene) { delete layout.xaxis; delete layout.yaxis; layout.margin = { l: 0, r: 0, t: 8, b: 8 }; }
    else delete layout.scene;
    return layout;
  }

  // Of what is not finite, or has no unit, nothing is changed.
  function inUnits(traces, layout, units) {
    traces.forEach(function (trace) {
      const unit = units[trace.legendgroup];
      if (unit) trace.y = trace.y.map(function (one) { return one === null ? null : one / unit; });
    });
    layout.yaxis.title.text = layout.yaxis.title.text.split(", in ")[0] + ", in u";
  }

  function chosen(figure) {
    const input = figure.querySelector(".choices input:checked");
    return input ? Number(input.value) : 0;
  }

  // A legend below a narrow picture takes lines of its own, and nothing of the picture's height.
  function makeRoom(plot, traces, layout) {
    if (layout.scene) layout.scene.camera.eye = { x: 2.1, y: 2.1, z: 1.4 };
    const named = traces.filter(function (one) { return one.showlegend !== false && one.name; }).length;
    if (layout.scene || named < 6) return;
    plot.style.height = 340 + 21 * named + "px";
    layout.margin = Object.assign({}, layout.margin, { b: 70 + 21 * named });
    layout.legend = Object.assign({}, layout.legend, { y: -60 / 240, yref: "paper" });
  }

  async function draw(plot) {
    const figure = plot.closest("figure");
    const stored = JSON.parse(document.getElementById(plot.dataset.figure).textContent);
    const drawing = stored.drawings[chosen(figure)];
    const narrow = plot.clientWidth < 560;
    const library_ = await plotly();
    const found = colours();
    const traces = filled(drawing.data, stored.columns, found);
    const layout = filled(layoutOf(stored, drawing, narrow), stored.columns, found);
    const units = figure.querySelector(".units input");
    if (units && units.checked) inUnits(traces, layout, stored.units);
    if (narrow) makeRoom(plot, traces, layout);
    await library_.react(
      plot,
      traces,
      layout,
      { responsive: true, displaylogo: false, displayModeBar: narrow ? false : "hover" },
    );
    plot.dataset.drawn = String(chosen(figure));
  }

  function tried(plot) {
    draw(plot).catch(function (reason) {
      plot.textContent = "This picture could not be drawn: " + (reason.message || "the script is missing") + ".";
    });
  }

  function begin() {
    const plots = Array.from(document.querySelectorAll(".plot"));
    const watch = new IntersectionObserver(function (entries) {
      entries.filter(function (entry) { return entry.isIntersecting; }).forEach(function (entry) {
        watch.unobserve(entry.target);
        tried(entry.target);
      });
    }, { rootMargin: "300px" });
    plots.forEach(function (plot) {
      watch.observe(plot);
      plot.closest("figure").querySelectorAll("input").forEach(function (input) {
        input.addEventListener("change", function () { tried(plot); });
      });
    });
    document.addEventListener("theme", function () {
      plots.filter(function (plot) { return plot.dataset.drawn !== undefined; }).forEach(tried);
    });
    // On paper nothing is scrolled into view.
    window.addEventListener("beforeprint", function () { plots.forEach(tried); });
  }

  if (document.querySelector(".plot")) begin();
})();
