'use strict';
/* The first page of a study: what it is, its plots and tables, its runs. */

hypotrack.counts = function (page) {
  var failed = page.runs.filter(function (run) { return run.failed; }).length;
  var seeds = {};
  page.runs.forEach(function (run) { seeds[run.seed] = true; });
  var done = page.runs.length === page.planned ? String(page.runs.length)
                                               : page.runs.length + ' of ' + page.planned + ' planned';
  var facts = [['runs', done], ['failed', String(failed)], ['seeds', String(Object.keys(seeds).length)]];
  var frames = page.runs.filter(function (run) { return !run.failed && run.metrics.frames; })
      .map(function (run) { return run.metrics.frames; });
  if (frames.length) {
    var least = Math.min.apply(null, frames), most = Math.max.apply(null, frames);
    facts.push(['frames per run', least === most ? String(most) : least + ' to ' + most]);
  }
  return facts;
};

/** The best setting of each scene by the mean error. */
hypotrack.bestSettings = function (page) {
  var facts = [];
  page.tables.forEach(function (table) {
    var column = table.columns.findIndex(function (c) { return c.key === 'mean_error_mm'; });
    if (column < 0) return;
    table.rows.forEach(function (row) {
      var cell = row.cells[column];
      if (!cell.best && !(table.rows.length === 1 && cell.mean !== null)) return;
      var settings = row.keys.map(function (key, i) { return table.keys[i] + ' ' + key; }).join(', ');
      facts.push([table.title + (settings ? ', best: ' + settings : ''),
                  cell.mean.toFixed(2) + (cell.sd === null ? '' : ' ± ' + cell.sd.toFixed(2)) + ' mm']);
    });
  });
  return facts;
};

hypotrack.failures = function (page) {
  var failed = page.runs.filter(function (run) { return run.failed; });
  if (!failed.length) return null;
  return hypotrack.section('Failures', [
    hypotrack.element('ul', {class: 'failures'}, failed.map(function (run) {
      return hypotrack.element('li', {}, [
        hypotrack.element('strong', {text: run.id}),
        hypotrack.element('span', {text: ' ' + hypotrack.settingsText(page, run) + ', seed ' + run.seed}),
        hypotrack.element('pre', {text: run.message}),
      ]);
    })),
  ]);
};

/** The list of runs with a box to look for some of them. */
hypotrack.runsSection = function (page) {
  var runs = page.runs.filter(function (run) { return !run.failed; });
  if (!runs.length) return null;
  var holder = hypotrack.element('div');
  function show(words) {
    var found = runs.filter(function (run) {
      var text = (run.id + ' ' + hypotrack.settingsText(page, run) + ' seed ' + run.seed).toLowerCase();
      return words.every(function (word) { return text.indexOf(word) >= 0; });
    });
    holder.textContent = '';
    holder.appendChild(hypotrack.runsTable(page, found));
  }
  var search = hypotrack.element('input', {type: 'search', id: 'find', placeholder: 'scene, setting, seed …', on: {
    input: function () { show(search.value.toLowerCase().split(/\s+/).filter(Boolean)); }}});
  show([]);
  return hypotrack.section('Runs', [
    hypotrack.element('p', {class: 'find'}, [
      hypotrack.element('label', {for: 'find', text: 'Find '}), search]),
    holder,
    page.left_out ? hypotrack.element('p', {class: 'note', text: page.left_out}) : null,
  ]);
};

hypotrack.overview = function (page) {
  return hypotrack.element('div', {class: 'overview'}, [
    hypotrack.element('h1', {tabindex: '-1', text: page.title}),
    page.about ? hypotrack.element('p', {class: 'about', text: page.about}) : null,
    hypotrack.facts(hypotrack.counts(page).concat(hypotrack.bestSettings(page))),
    page.plots.length ? hypotrack.section('Plots', page.plots.map(hypotrack.chart)) : null,
    page.tables.length ? hypotrack.section('Tables', page.tables.map(hypotrack.comparisonTable)) : null,
    hypotrack.failures(page),
    hypotrack.runsSection(page),
  ]);
};
