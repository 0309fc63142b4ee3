'use strict';
/* Plots in the page: drawn in the width that they have and the colours of the system. */

hypotrack.dark = window.matchMedia('(prefers-color-scheme: dark)');

/** Charts on the page now, to be drawn again when width or colours change. */
hypotrack.charts = [];

hypotrack.theme = function () {
  return hypotrack.themes[hypotrack.dark.matches ? 'dark' : 'light'];
};

/** A figure with a heading, the plot and a note. */
hypotrack.chart = function (plot) {
  var holder = hypotrack.element('div', {class: 'plot'});
  var figure = hypotrack.element('figure', {class: 'chart', id: plot.id}, [
    hypotrack.element('figcaption', {}, [hypotrack.element('h3', {text: plot.title})]), holder,
  ]);
  if (plot.note) figure.appendChild(hypotrack.note(plot.note));
  if (hypotrack.hasRows(plot))
    hypotrack.charts.push({plot: plot, holder: holder, width: 0, view: null});
  else
    holder.appendChild(hypotrack.note('No run has numbers for this plot.'));
  return figure;
};

hypotrack.drawChart = function (chart) {
  var width = Math.floor(chart.holder.clientWidth);
  if (width <= 0) return;
  chart.width = width;
  if (chart.view) chart.view.finalize();
  chart.holder.textContent = '';
  var spec = hypotrack.plotSpec(chart.plot, {width: width, theme: hypotrack.theme()});
  chart.view = new vega.View(vega.parse(spec), {
    renderer: 'svg', container: chart.holder, hover: false, tooltip: hypotrack.showTip,
  });
  chart.view.runAsync();
};

/** Vega's hover texts, in a box of the page's own. */
hypotrack.showTip = function (handler, event, item, value) {
  var box = document.getElementById('tip');
  box.hidden = value === null || value === undefined || value === '';
  if (box.hidden) return;
  box.textContent = value;
  var left = Math.min(event.clientX + 14, window.innerWidth - box.offsetWidth - 8);
  box.style.left = Math.max(8, left) + 'px';
  box.style.top = (event.clientY + 16) + 'px';
};

hypotrack.drawCharts = function (everything) {
  hypotrack.charts.forEach(function (chart) {
    if (everything || Math.abs(chart.holder.clientWidth - chart.width) > 1)
      hypotrack.drawChart(chart);
  });
};

hypotrack.forgetCharts = function () {
  hypotrack.charts.forEach(function (chart) { if (chart.view) chart.view.finalize(); });
  hypotrack.charts = [];
  document.getElementById('tip').hidden = true;
};
