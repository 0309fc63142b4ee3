'use strict';
/* Vega specifications of the plots that C++ describes (plot_data.hpp). Runs in the page and, for the
   files beside it, in Node.js. */

hypotrack.themes = {
  light: {
    background: '#ffffff', text: '#1d2430', muted: '#566074', grid: '#e3e7ee', shade: '#d64545',
    series: ['#1668b8', '#c8440a', '#12805a', '#8b44ac', '#96700a', '#c2185b', '#00798a', '#5d4037'],
    ordered: [0, 0.82],
  },
  dark: {
    background: '#161b24', text: '#e6eaf2', muted: '#a3adbf', grid: '#2c3442', shade: '#ff6b6b',
    series: ['#6db3f2', '#ff9a5c', '#5fd39b', '#cf9bea', '#f2c14e', '#ff7fa8', '#4dd0e1', '#bcaaa4'],
    ordered: [0.25, 1],
  },
};

hypotrack.shapes = ['circle', 'square', 'triangle-up', 'diamond', 'cross', 'triangle-down'];

/** Whether the values of an axis grow by factors rather than by steps. */
hypotrack.isGeometric = function (values) {
  if (values.length < 3 || values[0] <= 0) return false;
  var ratios = [], steps = [];
  for (var i = 1; i < values.length; i++) {
    ratios.push(values[i] / values[i - 1]);
    steps.push(values[i] - values[i - 1]);
  }
  var spread = function (list) { return Math.max.apply(null, list) / Math.min.apply(null, list); };
  return Math.min.apply(null, ratios) > 1 && spread(ratios) < spread(steps);
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

hypotrack.band = function (row) {
  return [row.mean - (row.sd || 0), row.mean + (row.sd || 0)];
};

hypotrack.tip = function (plot, row) {
  var digits = plot.value ? plot.value.digits : 1;
  var text = '';
  if (plot.color) text += plot.color.label + ' ' + row.color + '; ';
  text += plot.x.label + ' ' + row.x;
  if (row.y !== undefined) text += '; ' + plot.y.label + ' ' + row.y;
  text += ': ' + row.mean.toFixed(digits);
  if (row.sd !== null && row.sd !== undefined) text += ' ± ' + row.sd.toFixed(digits);
  return text + ' ' + (plot.value ? plot.value.label : plot.y.label) +
         ' (' + row.n + (row.n === 1 ? ' run)' : ' runs)');
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
  var range = ordered ? {scheme: 'viridis', count: values.length, extent: theme.ordered} : theme.series;
  return [{name: 'color', type: 'ordinal', domain: values, range: range},
          {name: 'shape', type: 'ordinal', domain: values, range: hypotrack.shapes}];
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
      }, facet.label ? {title: {text: facet.label, limit: size.width}} : {}, content('facet' + i));
    }),
  };
  if (plot.color && plot.color.values.length > 1) {
    spec.legends = [{
      fill: 'color', shape: 'shape', orient: 'top', direction: 'horizontal',
      title: plot.color.label, columns: Math.max(1, Math.floor(options.width / 110)),
    }];
  }
  return spec;
};

hypotrack.axes = function (plot, values, ticks) {
  return [
    Object.assign({orient: 'bottom', scale: 'x', title: plot.x.label, grid: false},
                  values ? {values: values} : {tickCount: ticks}),
    {orient: 'left', scale: 'y', title: plot.y.label, grid: true, tickCount: 6},
  ];
};

/** Lines of the mean with bands of one standard deviation. */
hypotrack.lineMarks = function (data, points) {
  var x = {scale: 'x', field: 'x'}, color = {scale: 'color', field: 'color'};
  var inner = [
    {type: 'area', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'lo'}, y2: {scale: 'y', field: 'hi'},
      fill: color, fillOpacity: {value: 0.18}}}},
    {type: 'line', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'mean'}, stroke: color, strokeWidth: {value: 2}}}},
    {type: 'symbol', from: {data: 'series'}, encode: {update: {
      x: x, y: {scale: 'y', field: 'mean'}, fill: color, size: {value: points ? 50 : 60},
      shape: {scale: 'shape', field: 'color'}, opacity: {value: points ? 1 : 0},
      tooltip: {field: 'tip'}}}},
  ];
  return [{type: 'group', from: {facet: {data: data, name: 'series', groupby: 'color'}},
           marks: inner}];
};

hypotrack.curveSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width), values = plot.x.values;
  var bounds = hypotrack.rangeOf(plot, hypotrack.band);
  var x = {name: 'x', domain: [values[0], values[values.length - 1]], range: [0, size.width]};
  if (!plot.x.numeric || values.length < 2)
    Object.assign(x, {type: 'point', domain: values, padding: 0.5});
  else if (hypotrack.isGeometric(values)) Object.assign(x, {type: 'log', base: 2});
  else Object.assign(x, {type: 'linear', zero: false,
                         domain: [Math.min.apply(null, values), Math.max.apply(null, values)]});
  var y = {name: 'y', type: 'linear', domain: bounds, nice: true, zero: false,
           range: [size.height, 0]};
  return hypotrack.facetSpec(plot, options, size,
      [x, y].concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        return {axes: hypotrack.axes(plot, values.length <= 12 ? values : null, 8),
                marks: hypotrack.lineMarks(data, true)};
      });
};

hypotrack.successSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width);
  var bounds = hypotrack.rangeOf(plot, function (row) { return [row.x]; });
  var scales = [
    {name: 'x', type: 'linear', domain: bounds, zero: false, range: [0, size.width]},
    {name: 'y', type: 'linear', domain: [0, 100], clamp: true, range: [size.height, 0]},
  ];
  return hypotrack.facetSpec(plot, options, size,
      scales.concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        return {axes: hypotrack.axes(plot, null, 6), marks: hypotrack.lineMarks(data, false)};
      });
};

/** Bars along `band` ('x' or 'y') as long as the mean, with a line of one standard deviation. */
hypotrack.barMarks = function (data, band, theme) {
  var value = band === 'x' ? 'y' : 'x';
  function place(share) {
    return {scale: 'band', field: 'x', offset: {scale: 'inner', field: 'color', band: share}};
  }
  var bar = {fill: {scale: 'color', field: 'color'}, tooltip: {field: 'tip'}};
  bar[band] = place(0);
  bar[band === 'x' ? 'width' : 'height'] = {scale: 'inner', band: 1};
  bar[value] = {scale: 'value', field: 'mean'};
  bar[value + '2'] = {scale: 'value', value: 0};
  var spread = {stroke: {value: theme.text}, strokeWidth: {value: 1.5}};
  spread[band] = place(0.5);
  spread[value] = {scale: 'value', field: 'lo'};
  spread[value + '2'] = {scale: 'value', field: 'hi'};
  return [{type: 'rect', from: {data: data}, encode: {update: bar}},
          {type: 'rule', from: {data: data}, encode: {update: spread}}];
};

/** Upright bars, or lying ones where the names would not fit below. */
hypotrack.barsSpec = function (plot, options) {
  var names = plot.x.values, colors = plot.color ? plot.color.values : [''];
  var size = hypotrack.panels(plot, options.width), bounds = hypotrack.rangeOf(plot, hypotrack.band);
  var flat = 7 * names.join('  ').length > size.width;
  if (flat) {
    size.width -= Math.min(100, 5 * Math.max.apply(null, names.map(function (name) {
      return String(name).length;
    })));
    size.height = names.length * Math.max(17, 11 * colors.length + 6);
  }
  var scales = [
    {name: 'band', type: 'band', domain: names, range: [0, flat ? size.height : size.width],
     padding: 0.25},
    {name: 'inner', type: 'band', domain: colors, range: [0, {signal: "bandwidth('band')"}],
     padding: 0.06},
    {name: 'value', type: 'linear', domain: [Math.min(0, bounds[0]), bounds[1]], nice: true,
     range: flat ? [0, size.width] : [size.height, 0]},
  ];
  var axes = [
    {orient: flat ? 'left' : 'bottom', scale: 'band', title: flat ? undefined : plot.x.label,
     labelOverlap: false},
    {orient: flat ? 'bottom' : 'left', scale: 'value', title: plot.y.label, grid: true,
     tickCount: flat ? Math.floor(size.width / 60) : 6},
  ];
  return hypotrack.facetSpec(plot, options, size,
      scales.concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        return {axes: axes, marks: hypotrack.barMarks(data, flat ? 'y' : 'x', options.theme)};
      });
};

hypotrack.heatmapSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width);
  var bounds = hypotrack.rangeOf(plot, function (row) { return [row.mean]; });
  var middle = bounds[0] + 0.55 * (bounds[1] - bounds[0]);
  var scales = [
    {name: 'x', type: 'band', domain: plot.x.values, range: [0, size.width]},
    {name: 'y', type: 'band', domain: plot.y.values, range: [size.height, 0]},
    {name: 'value', type: 'linear', domain: bounds, zero: false, range: {scheme: 'viridis'}},
  ];
  var cell = {x: {scale: 'x', field: 'x'}, y: {scale: 'y', field: 'y'}};
  var spec = hypotrack.facetSpec(plot, options, size, scales, function (data) {
    var axes = hypotrack.axes(plot, null, 8);
    axes[1].grid = false;
    return {axes: axes, marks: [
      {type: 'rect', from: {data: data}, encode: {update: Object.assign({}, cell, {
        width: {scale: 'x', band: 1}, height: {scale: 'y', band: 1},
        fill: {scale: 'value', field: 'mean'}, tooltip: {field: 'tip'}})}},
      {type: 'text', from: {data: data}, interactive: false, encode: {update: {
        x: {scale: 'x', field: 'x', band: 0.5}, y: {scale: 'y', field: 'y', band: 0.5},
        align: {value: 'center'}, baseline: {value: 'middle'}, fontSize: {value: 12},
        fill: {signal: "datum.mean < " + middle + " ? '#ffffff' : '#111111'"},
        text: {signal: "format(datum.mean, '." + plot.value.digits + "f')"}}}},
    ]};
  });
  spec.legends = [{fill: 'value', type: 'gradient', orient: 'top', direction: 'horizontal',
                   title: plot.value.label, gradientLength: Math.min(240, size.width)}];
  return spec;
};

/** Values over the frames of a run: {title, x: {label, values}, y: {label}, series: [{name, values}],
    shaded: [[from, to], ...], zero}. */
hypotrack.timelineSpec = function (plot, options) {
  var theme = options.theme, width = Math.max(220, options.width - 90);
  var rows = [];
  plot.series.forEach(function (series) {
    for (var i = 0; i < series.values.length; i++)
      rows.push({s: series.name, x: plot.x.values[i],
                 y: isFinite(series.values[i]) ? series.values[i] : null});
  });
  var x = {scale: 'x', field: 'x'}, color = {scale: 'color', field: 's'};
  var names = plot.series.map(function (series) { return series.name; });
  var spec = {
    description: plot.title, background: theme.background, padding: 8, width: width,
    height: Math.round(Math.max(150, Math.min(230, 0.3 * width))),
    config: hypotrack.plotConfig(theme),
    data: [{name: 'rows', values: rows},
           {name: 'shaded', values: plot.shaded.map(function (span) {
             return {from: span[0] - 0.5, to: span[1] + 0.5};
           })}],
    scales: [
      {name: 'x', type: 'linear', zero: false, range: 'width',
       domain: [plot.x.values[0], Math.max(plot.x.values[plot.x.values.length - 1],
                                           plot.x.values[0] + 1)]},
      {name: 'y', type: 'linear', domain: {data: 'rows', field: 'y'}, nice: true,
       zero: plot.zero, range: 'height'},
      {name: 'color', type: 'ordinal', domain: names, range: theme.series},
    ],
    axes: [{orient: 'bottom', scale: 'x', title: plot.x.label, tickCount: Math.floor(width / 80)},
           {orient: 'left', scale: 'y', title: plot.y.label, grid: true, tickCount: 5}],
    marks: [
      {type: 'rect', from: {data: 'shaded'}, encode: {update: {
        x: {scale: 'x', field: 'from'}, x2: {scale: 'x', field: 'to'}, y: {value: 0},
        y2: {signal: 'height'}, fill: {value: theme.shade}, fillOpacity: {value: 0.16}}}},
      {type: 'group', from: {facet: {data: 'rows', name: 'line', groupby: 's'}}, marks: [
        {type: 'line', from: {data: 'line'}, encode: {update: {
          x: x, y: {scale: 'y', field: 'y'}, stroke: color, strokeWidth: {value: 1.6},
          defined: {signal: 'isValid(datum.y)'}}}}]},
    ],
  };
  if (names.length > 1)
    spec.legends = [{stroke: 'color', symbolType: 'stroke', orient: 'top', direction: 'horizontal',
                     columns: Math.max(1, Math.floor(width / 110))}];
  return spec;
};

hypotrack.plotSpec = function (plot, options) {
  return {
    curve: hypotrack.curveSpec, success: hypotrack.successSpec, bars: hypotrack.barsSpec,
    heatmap: hypotrack.heatmapSpec, timeline: hypotrack.timelineSpec,
  }[plot.kind](plot, options);
};
