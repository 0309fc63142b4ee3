'use strict';
/* Vega specifications of the plots that C++ describes (plot_data.hpp). Runs in the page and, for
   the files beside it, in Node.js. */

/** The scale of a curve's values: logarithmic where one mean is many times another, so that the
    small ones can be told apart. */
hypotrack.curveScale = function (plot, size) {
  var band = hypotrack.rangeOf(plot, hypotrack.band);
  var means = hypotrack.rangeOf(plot, function (row) { return [row.mean]; });
  var scale = {name: 'y', range: [size.height, 0], zero: false};
  if (means[0] > 0 && means[1] > 6 * means[0])
    return Object.assign(scale, {type: 'log', clamp: true,
                                 domain: [Math.max(band[0], means[0] / 1.5), band[1]]});
  return Object.assign(scale, {type: 'linear', domain: band});
};

hypotrack.curveSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width), values = plot.x.values;
  var x = {name: 'x', domain: [values[0], values[values.length - 1]], range: [0, size.width]};
  if (!plot.x.numeric || values.length < 2)
    Object.assign(x, {type: 'point', domain: values, padding: 0.5});
  else if (hypotrack.isGeometric(values)) Object.assign(x, {type: 'log', base: 2});
  else Object.assign(x, {type: 'linear', zero: false,
                         domain: [Math.min.apply(null, values), Math.max.apply(null, values)]});
  var y = hypotrack.curveScale(plot, size);
  return hypotrack.facetSpec(plot, options, size,
      [x, y].concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        return {axes: hypotrack.axes(plot, values.length <= 12 ? values : null, 8,
                                     y.type === 'log' ? hypotrack.logTicks(y.domain) : null),
                marks: hypotrack.lineMarks(plot, options, data)};
      });
};

/** The error from which on no line of a success plot rises any more. */
hypotrack.endOfRise = function (plot) {
  var end = 0;
  plot.facets.forEach(function (facet) {
    var last = {};
    facet.rows.forEach(function (row) { last[row.color] = row.mean; });
    facet.rows.forEach(function (row, i) {
      if (row.mean >= last[row.color] - 0.05) return;
      var next = facet.rows.slice(i + 1).find(function (other) {
        return other.color === row.color;
      });
      end = Math.max(end, next.x);
    });
  });
  return end;
};

hypotrack.successSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width);
  var bounds = hypotrack.rangeOf(plot, function (row) { return [row.x]; });
  var end = Math.min(bounds[1], Math.max(bounds[0] + 1, hypotrack.endOfRise(plot)));
  bounds[1] = end;
  plot = Object.assign({}, plot, {facets: plot.facets.map(function (facet) {
    return Object.assign({}, facet, {rows: facet.rows.filter(function (row) {
      return row.x <= end;
    })});
  })});
  var scales = [
    {name: 'x', type: 'linear', domain: bounds, zero: false, range: [0, size.width]},
    {name: 'y', type: 'linear', domain: [0, 100], clamp: true, range: [size.height, 0]},
  ];
  return hypotrack.facetSpec(plot, options, size,
      scales.concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        return {axes: hypotrack.axes(plot, null, 6),
                marks: hypotrack.lineMarks(plot, options, data)};
      });
};

/** Marks of an axis on both sides of zero, 1, 2 and 5 times a power of ten. */
hypotrack.symlogTicks = function (bounds) {
  var most = Math.max(-bounds[0], bounds[1]);
  var above = most < 1 ? [] : hypotrack.logTicks([1, most]);
  var below = above.map(function (tick) { return -tick; }).reverse();
  return below.concat([0], above).filter(function (tick) {
    return tick >= bounds[0] && tick <= bounds[1];
  });
};

/** How searches converge: bands over what they spend, distributions of it, or what a target takes
    (trace_plots.hpp). */
hypotrack.tracedSpec = function (plot, options) {
  var size = hypotrack.panels(plot, options.width), targets = plot.kind === 'expected_running_time';
  var bounds = hypotrack.rangeOf(plot, function (row) { return [row.x]; });
  if (bounds[0] === bounds[1]) bounds[1] *= 2;
  var x = {name: 'x', type: 'log', domain: bounds, range: [0, size.width]};
  var y = {name: 'y', type: 'linear', domain: [0, 100], range: [size.height, 0]};
  var xTicks = hypotrack.logTicks(bounds), yTicks = null;
  if (targets) {
    xTicks = [];
    plot.facets.forEach(function (facet) {
      facet.rows.forEach(function (row) { if (xTicks.indexOf(row.x) < 0) xTicks.push(row.x); });
    });
    xTicks.sort(function (a, b) { return a - b; });
    Object.assign(x, {type: 'point', domain: xTicks, padding: 0.5});
  }
  if (plot.kind === 'convergence' || targets) {
    y.domain = hypotrack.rangeOf(plot, hypotrack.band);
    y.type = targets ? 'log' : plot.y.scale;
    y.zero = false;
    if (y.domain[0] === y.domain[1]) y.domain[1] = y.domain[0] + Math.abs(y.domain[0] || 1);
    if (targets) yTicks = hypotrack.logTicks(y.domain);
    if (y.type === 'symlog') yTicks = hypotrack.symlogTicks(y.domain);
  }
  return hypotrack.facetSpec(plot, options, size,
      [x, y].concat(hypotrack.colorScales(plot, options.theme)), function (data) {
        var axes = hypotrack.axes(plot, xTicks, 0, yTicks);
        if (!targets) axes[0].format = '~r';
        return {axes: axes,
                marks: hypotrack.lineMarks(plot, options, data, targets ? 'linear' : 'step-after')};
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
  var interval = {stroke: {value: theme.text}, strokeWidth: {value: 1.5}};
  interval[band] = place(0.5);
  interval[value] = {scale: 'value', field: 'lo'};
  interval[value + '2'] = {scale: 'value', field: 'hi'};
  return [{type: 'rect', from: {data: data}, encode: {update: bar}},
          {type: 'rule', from: {data: data}, encode: {update: interval}}];
};

/** Upright bars, or lying ones where the names would not fit below. */
hypotrack.barsSpec = function (plot, options) {
  var names = plot.x.values, colors = plot.color ? plot.color.values : [''];
  var size = hypotrack.panels(plot, options.width);
  var bounds = hypotrack.rangeOf(plot, hypotrack.band);
  var flat = 7 * names.join('  ').length > size.width;
  var room = 0;  // for the names of lying bars, half of the panel at most
  if (flat) {
    room = Math.min(Math.floor(size.width / 2), hypotrack.textWidth(names));
    size.width -= Math.max(0, room - 40);
    size.height = names.length * Math.max(17, 11 * colors.length + 6);
  }
  var scales = [
    {name: 'band', type: 'band', domain: names, range: [0, flat ? size.height : size.width],
     padding: 0.25},
    {name: 'inner', type: 'band', domain: colors, range: [0, {signal: "bandwidth('band')"}],
     padding: 0.06},
    {name: 'value', type: 'linear', domain: [Math.min(0, bounds[0]), bounds[1]],
     range: flat ? [0, size.width] : [size.height, 0]},
  ];
  var axes = [
    {orient: flat ? 'left' : 'bottom', scale: 'band', title: flat ? undefined : plot.x.label,
     labelOverlap: false, labelLimit: flat ? room : size.width},
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

/** Values over the frames of a run: {title, x: {label, values}, y: {label},
    series: [{name, values, marks: whether points are drawn and no line}],
    shaded: [[from, to], ...], zero}. */
hypotrack.timelineSpec = function (plot, options) {
  var theme = options.theme, width = Math.max(220, options.width - 90);
  var rows = [];
  plot.series.forEach(function (series) {
    for (var i = 0; i < series.values.length; i++)
      rows.push({s: series.name, marks: Boolean(series.marks), x: plot.x.values[i],
                 y: isFinite(series.values[i]) ? series.values[i] : null});
  });
  var x = {scale: 'x', field: 'x'}, color = {scale: 'color', field: 's'};
  var names = plot.series.map(function (series) { return series.name; });
  var shapes = plot.series.map(function (series, i) {
    return series.marks ? hypotrack.shapes[i % hypotrack.shapes.length] : 'stroke';
  });
  var spec = {
    description: plot.title, background: theme.background, padding: 8, width: width,
    height: Math.round(Math.max(150, Math.min(230, 0.3 * width))),
    config: hypotrack.plotConfig(theme),
    data: [{name: 'rows', values: rows},
           {name: 'lines', source: 'rows', transform: [{type: 'filter', expr: '!datum.marks'}]},
           {name: 'marks', source: 'rows',
            transform: [{type: 'filter', expr: 'datum.marks && isValid(datum.y)'}]},
           {name: 'shaded', values: plot.shaded.map(function (span) {
             return {from: span[0] - 0.5, to: span[1] + 0.5};
           })}],
    scales: [
      {name: 'x', type: 'linear', zero: false, range: 'width',
       domain: [plot.x.values[0], Math.max(plot.x.values[plot.x.values.length - 1],
                                           plot.x.values[0] + 1)]},
      {name: 'y', type: 'linear', domain: {data: 'rows', field: 'y'},
       zero: plot.zero, range: 'height'},
      {name: 'color', type: 'ordinal', domain: names, range: theme.series},
      {name: 'shape', type: 'ordinal', domain: names, range: shapes},
    ],
    axes: [{orient: 'bottom', scale: 'x', title: plot.x.label, tickCount: Math.floor(width / 80)},
           {orient: 'left', scale: 'y', title: plot.y.label, grid: true, tickCount: 5}],
    marks: [
      {type: 'rect', from: {data: 'shaded'}, encode: {update: {
        x: {scale: 'x', field: 'from'}, x2: {scale: 'x', field: 'to'}, y: {value: 0},
        y2: {signal: 'height'}, fill: {value: theme.shade}, fillOpacity: {value: 0.16}}}},
      {type: 'group', from: {facet: {data: 'lines', name: 'line', groupby: 's'}}, marks: [
        {type: 'line', from: {data: 'line'}, encode: {update: {
          x: x, y: {scale: 'y', field: 'y'}, stroke: color, strokeWidth: {value: 1.6},
          defined: {signal: 'isValid(datum.y)'}}}}]},
      {type: 'symbol', from: {data: 'marks'}, encode: {update: {
        x: x, y: {scale: 'y', field: 'y'}, stroke: color, strokeWidth: {value: 1.6},
        shape: {scale: 'shape', field: 's'}, size: {value: 40}}}},
    ],
  };
  if (names.length > 1)
    spec.legends = [{stroke: 'color', shape: 'shape', orient: 'top', direction: 'horizontal',
                     labelLimit: width, columns: hypotrack.legendColumns(names, width)}];
  return spec;
};

/** Whether there is anything to draw. */
hypotrack.hasRows = function (plot) {
  return plot.kind === 'timeline' ||
         plot.facets.some(function (facet) { return facet.rows.length > 0; });
};

hypotrack.plotSpec = function (plot, options) {
  return {
    curve: hypotrack.curveSpec, success: hypotrack.successSpec, bars: hypotrack.barsSpec,
    heatmap: hypotrack.heatmapSpec, timeline: hypotrack.timelineSpec,
    convergence: hypotrack.tracedSpec, targets: hypotrack.tracedSpec,
    performance_profile: hypotrack.tracedSpec, data_profile: hypotrack.tracedSpec,
    expected_running_time: hypotrack.tracedSpec,
  }[plot.kind](plot, options);
};
