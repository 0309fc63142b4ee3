'use strict';
/* What plots have in common: colours, panels, axes, lines. Runs in the page and, for the files
   beside it, in Node.js. */

hypotrack.themes = {
  light: {
    background: '#ffffff', text: '#1d2430', muted: '#566074', grid: '#e3e7ee', shade: '#d64545',
    series: ['#1668b8', '#c8440a', '#12805a', '#8b44ac', '#96700a', '#c2185b', '#00798a',
             '#5d4037'],
    ordered: [0, 0.82],
  },
  dark: {
    background: '#161b24', text: '#e6eaf2', muted: '#a3adbf', grid: '#2c3442', shade: '#ff6b6b',
    series: ['#6db3f2', '#ff9a5c', '#5fd39b', '#cf9bea', '#f2c14e', '#ff7fa8', '#4dd0e1',
             '#bcaaa4'],
    ordered: [0.25, 1],
  },
};

hypotrack.shapes = ['circle', 'square', 'triangle-up', 'diamond', 'cross', 'triangle-down'];
/** Of lines; the next begins where colours repeat. */
hypotrack.dashes = [[1, 0], [7, 3], [2, 2], [9, 3, 2, 3]];

/** Whether the values of an axis grow by factors rather than by steps. */
hypotrack.isGeometric = function (values) {
  if (values.length < 3 || values[0] <= 0) return false;
  var ratios = [], steps = [];
  for (var i = 1; i < values.length; i++) {
    ratios.push(values[i] / values[i - 1]);
    steps.push(values[i] - values[i - 1]);
  }
  var ratio = function (list) { return Math.max.apply(null, list) / Math.min.apply(null, list); };
  return Math.min.apply(null, ratios) > 1 && ratio(ratios) < ratio(steps);
};

hypotrack.plotConfig = function (theme) {
  var font = 'system-ui, "Segoe UI", Roboto, "DejaVu Sans", Arial, sans-serif';
  return {
    axis: {
      labelColor: theme.text, titleColor: theme.text, domainColor: theme.muted, labelFont: font,
      tickColor: theme.muted, gridColor: theme.grid, labelFontSize: 12, titleFontSize: 12,
      titleFontWeight: 500, titleFont: font, titlePadding: 8, labelOverlap: true,
    },
    legend: {
      labelColor: theme.text, titleColor: theme.text, labelFontSize: 12, titleFontSize: 12,
      titleFontWeight: 500, labelFont: font, titleFont: font, symbolStrokeWidth: 2,
    },
    title: {color: theme.text, font: font, fontSize: 13, fontWeight: 600, anchor: 'start'},
    text: {font: font, fill: theme.text},
  };
};

/** Sizes of the panels, one per facet, in `width` pixels. */
hypotrack.panels = function (plot, width) {
  var facets = plot.facets.length;
  var columns = Math.max(1, Math.min(facets, Math.floor(width / 330)));
  var panel = Math.max(170, Math.min(560, Math.floor((width - 16) / columns - 76)));
  return {columns: columns, width: panel,
          height: Math.round(Math.max(190, Math.min(300, 0.62 * panel)))};
};

hypotrack.rangeOf = function (plot, read) {
  var lowest = Infinity, highest = -Infinity;
  plot.facets.forEach(function (facet) {
    facet.rows.forEach(function (row) {
      read(row).forEach(function (value) {
        lowest = Math.min(lowest, value);
        highest = Math.max(highest, value);
      });
    });
  });
  return lowest <= highest ? [lowest, highest] : [0, 1];
};

/** The band of a row: its bounds or, without, one standard deviation around the mean. That of what
    is never negative stays above zero. */
hypotrack.band = function (row) {
  if (row.lo !== undefined) return [row.lo, row.hi];
  var low = row.mean - (row.sd || 0);
  return [row.mean < 0 ? low : Math.max(0, low), row.mean + (row.sd || 0)];
};

hypotrack.tip = function (plot, row) {
  var digits = plot.value ? plot.value.digits : 1;
  var text = '';
  if (plot.color) text += plot.color.label + ' ' + row.color + '; ';
  text += plot.x.label + ' ' + (plot.counted ? Number(row.x.toPrecision(3)) : row.x);
  if (row.y !== undefined) text += '; ' + plot.y.label + ' ' + row.y;
  text += ': ' + row.mean.toFixed(digits);
  if (row.sd !== null && row.sd !== undefined) text += ' ± ' + row.sd.toFixed(digits);
  var counted = plot.counted || (row.n === 1 ? 'run' : 'runs');
  return text + ' ' + (plot.value ? plot.value.label : plot.y.label) +
         ' (' + row.n + ' ' + counted + ')';
};

/** About how many pixels the longest of some names takes. */
hypotrack.textWidth = function (names) {
  return 7 * Math.max.apply(null, names.map(function (name) { return String(name).length; }));
};

/** How many names of a legend fit side by side. */
hypotrack.legendColumns = function (names, width) {
  return Math.max(1, Math.floor(width / (hypotrack.textWidth(names) + 40)));
};

/** A text in lines of at most `width` pixels, broken between words. */
hypotrack.wrapped = function (text, width) {
  var lines = [''];
  String(text).split(' ').forEach(function (word) {
    var line = lines[lines.length - 1];
    if (line && hypotrack.textWidth([line + ' ' + word]) > width) lines.push(word);
    else lines[lines.length - 1] = line ? line + ' ' + word : word;
  });
  return lines;
};

/** Whether any row has a band. */
hypotrack.hasBands = function (plot) {
  return plot.facets.some(function (facet) {
    return facet.rows.some(function (row) { return row.lo !== undefined || row.sd; });
  });
};

/** The rows of each facet as data sets, with the bounds of the band and a text to hover. */
hypotrack.plotTables = function (plot) {
  return plot.facets.map(function (facet, i) {
    return {name: 'facet' + i, values: facet.rows.map(function (row) {
      var band = hypotrack.band(row);
      return Object.assign({color: ''}, row,
                           {lo: band[0], hi: band[1], tip: hypotrack.tip(plot, row)});
    })};
  });
};

hypotrack.colorScales = function (plot, theme) {
  var values = plot.color ? plot.color.values : [''];
  var ordered = plot.color && plot.color.numeric && values.length > 2;
  var range = ordered ? {scheme: 'viridis', count: values.length, extent: theme.ordered}
                      : theme.series;
  var dashes = values.map(function (value, i) {
    var turn = ordered ? 0 : Math.floor(i / theme.series.length);
    return hypotrack.dashes[turn % hypotrack.dashes.length];
  });
  return [{name: 'color', type: 'ordinal', domain: values, range: range},
          {name: 'dash', type: 'ordinal', domain: values, range: dashes},
          {name: 'shape', type: 'ordinal', domain: values, range: hypotrack.shapes}];
};

/** Whether a plot has lines without marks at their points. */
hypotrack.isBareLine = function (plot) {
  return ['success', 'convergence', 'targets', 'performance_profile',
          'data_profile'].indexOf(plot.kind) >= 0;
};

/** A specification with a panel per facet; `content(name of the data)` gives its axes and marks. */
hypotrack.facetSpec = function (plot, options, size, scales, content) {
  var theme = options.theme;
  var spec = {
    description: plot.title, background: theme.background, padding: 8,
    autosize: {type: 'pad', resize: true}, config: hypotrack.plotConfig(theme),
    data: hypotrack.plotTables(plot), scales: scales,
    layout: {columns: size.columns, padding: {column: 20, row: 24}, bounds: 'full', align: 'all'},
    marks: plot.facets.map(function (facet, i) {
      return Object.assign({
        type: 'group',
        encode: {update: {width: {value: size.width}, height: {value: size.height}}},
        // Of the panel, for its axes' grid lines.
        signals: [{name: 'width', value: size.width}, {name: 'height', value: size.height}],
      }, facet.label ? {title: {text: hypotrack.wrapped(facet.label, size.width),
                                 limit: size.width}} : {}, content('facet' + i));
    }),
  };
  if (plot.color && plot.color.values.length > 1) {
    spec.legends = [Object.assign({
      orient: 'top', direction: 'horizontal',
      title: plot.color.label, labelLimit: options.width - 40,
      columns: hypotrack.legendColumns(plot.color.values, options.width),
    }, hypotrack.isBareLine(plot) ? {stroke: 'color', strokeDash: 'dash', symbolType: 'stroke',
                                     symbolSize: 500}
                                  : {fill: 'color', shape: 'shape'})];
  }
  return spec;
};

/** The numbers 1, 2 and 5 times a power of ten between two bounds: marks of a logarithmic axis. */
hypotrack.logTicks = function (bounds) {
  var ticks = [];
  for (var power = Math.floor(Math.log10(bounds[0])); Math.pow(10, power) <= bounds[1]; power++)
    [1, 2, 5].forEach(function (digit) {
      var tick = Number(digit + 'e' + power);
      if (tick >= bounds[0] && tick <= bounds[1]) ticks.push(tick);
    });
  return ticks;
};

hypotrack.axes = function (plot, values, ticks, yValues) {
  return [
    Object.assign({orient: 'bottom', scale: 'x', title: plot.x.label, grid: false},
                  values ? {values: values} : {tickCount: ticks}),
    Object.assign({orient: 'left', scale: 'y', title: plot.y.label, grid: true},
                  yValues ? {values: yValues, format: '~r'} : {tickCount: 6}),
  ];
};

/** Lines of the mean with bands; `interpolate` is Vega's way between points. Points without marks
    can be hovered over, but not in a file (`options.still`). */
hypotrack.lineMarks = function (plot, options, data, interpolate) {
  var points = !hypotrack.isBareLine(plot);
  var lines = plot.color ? plot.color.values.length : 1;
  var x = {scale: 'x', field: 'x'}, color = {scale: 'color', field: 'color'};
  var way = {value: interpolate || 'linear'};
  var inner = [
    {type: 'area', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'lo'}, y2: {scale: 'y', field: 'hi'},
      interpolate: way, fill: color, fillOpacity: {value: Math.min(0.18, 1 / lines)}}}},
    {type: 'line', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'mean'}, stroke: color, strokeWidth: {value: 2},
      strokeDash: {scale: 'dash', field: 'color'}, interpolate: way}}},
    {type: 'symbol', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'mean'}, fill: color, size: {value: points ? 50 : 60},
      shape: {scale: 'shape', field: 'color'}, opacity: {value: points ? 1 : 0},
      tooltip: {field: 'tip'}}}},
  ];
  if (!points && options.still) inner.pop();
  if (!hypotrack.hasBands(plot)) inner.shift();
  return [{type: 'group', from: {facet: {data: data, name: 'series', groupby: 'color'}},
           marks: inner}];
};
