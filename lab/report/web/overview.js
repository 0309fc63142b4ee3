'use strict';
/* The first page of a study: what it is, its plots and tables, its runs. */

hypotrack.counts = function (page) {
  var failed = page.runs.filter(function (run) { return run.failed; }).length;
  var seeds = {};
  page.runs.forEach(function (run) { seeds[run.seed] = true; });
  var done = String(page.runs.length);
  if (page.runs.length !== page.planned) done += ' of ' + page.planned + ' planned';
  var facts = [['runs', done], ['failed', failed], ['seeds', Object.keys(seeds).length]];
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
      var settings = row.keys.map(function (key, i) { return table.keys[i] + ' ' + key; });
      var deviation = cell.sd === null ? '' : ' ± ' + cell.sd.toFixed(2);
      facts.push([table.title + (settings.length ? ', best: ' + settings.join(', ') : ''),
                  cell.mean.toFixed(2) + deviation + ' mm']);
    });
  });
  return facts;
};

/** Each message once, with the runs that ended with it. */
hypotrack.failures = function (page) {
  var byMessage = new Map();
  page.runs.filter(function (run) { return run.failed; }).forEach(function (run) {
    if (!byMessage.has(run.message)) byMessage.set(run.message, []);
    byMessage.get(run.message).push(run);
  });
  if (!byMessage.size) return null;
  var items = Array.from(byMessage, function (entry) {
    var runs = entry[1].map(function (run) {
      return hypotrack.element('li', {text:
          hypotrack.settingsText(page, run) + ' · seed ' + run.seed + ' (' + run.id + ')'});
    });
    return hypotrack.element('li', {}, [
      hypotrack.element('pre', {text: entry[0]}),
      hypotrack.element('details', {}, [
        hypotrack.element('summary', {text: runs.length + (runs.length === 1 ? ' run' : ' runs')}),
        hypotrack.element('ul', {}, runs),
      ]),
    ]);
  });
  return hypotrack.section('Failures', [hypotrack.element('ul', {class: 'failures'}, items)]);
};

/** The list of runs with a box to look for some of them. */
hypotrack.runsSection = function (page) {
  var runs = page.runs.filter(function (run) { return !run.failed; });
  if (!runs.length) return null;
  var holder = hypotrack.element('div');
  function show(words) {
    var found = runs.filter(function (run) {
      var text = run.id + ' ' + hypotrack.settingsText(page, run) + ' seed ' + run.seed;
      return words.every(function (word) { return text.toLowerCase().indexOf(word) >= 0; });
    });
    holder.textContent = '';
    holder.appendChild(hypotrack.runsTable(page, found));
    hypotrack.markWideTables();
  }
  var search = hypotrack.element('input', {
    type: 'search', id: 'find', placeholder: 'scene, setting, seed …',
    on: {input: function () { show(search.value.toLowerCase().split(/\s+/).filter(Boolean)); }},
  });
  show([]);
  return hypotrack.section('Runs', [
    hypotrack.element('p', {class: 'find'}, [
      hypotrack.element('label', {for: 'find', text: 'Find '}), search]),
    holder,
    hypotrack.note(page.left_out),
  ]);
};

hypotrack.overview = function (page) {
  function list(title, entries, show) {
    return entries.length ? hypotrack.section(title, entries.map(show)) : null;
  }
  return hypotrack.element('div', {class: 'overview'}, [
    hypotrack.element('h1', {tabindex: '-1', text: page.title}),
    page.about ? hypotrack.element('p', {class: 'about', text: page.about}) : null,
    hypotrack.facts(hypotrack.counts(page).concat(hypotrack.bestSettings(page))),
    list('Plots', page.plots, hypotrack.chart),
    list('Tables', page.tables, hypotrack.comparisonTable),
    hypotrack.failures(page),
    hypotrack.runsSection(page),
  ]);
};
