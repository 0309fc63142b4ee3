'use strict';
/* The plots of one run, described as timelineSpec and its kind take them. */

/** Above this error (mm) a frame counts as lost. */
hypotrack.lostAbove = 40;

/** Spans of frames [first, last] in which the target is lost. */
hypotrack.lostSpans = function (series) {
  var frames = hypotrack.framesOf(series);
  var errors = series.error ? hypotrack.numbers(series.error) : null;
  var spans = [], open = null;
  for (var i = 0; i < series.count; i++) {
    var lost = series.status[i] === 'l' || (errors && errors[i] > hypotrack.lostAbove);
    if (lost && open) open[1] = frames[i];
    else if (lost) spans.push(open = [frames[i], frames[i]]);
    else open = null;
  }
  return spans;
};

/** What wrong frames of a traced run are due to, by the letter of their outcome. */
hypotrack.wrongOutcomes = [
  {letter: 's', name: 'search failed', why: 'the truth costs less, or there is no answer'},
  {letter: 'o', name: 'objective failed', why: 'the truth costs no less'},
];

/** Spans of frames [first, last] with the outcome of a letter. */
hypotrack.outcomeSpans = function (series, letter) {
  var frames = hypotrack.framesOf(series), spans = [];
  for (var i = 0; i < series.count; i++) {
    if (series.outcome[i] !== letter) continue;
    if (i > 0 && series.outcome[i - 1] === letter) spans[spans.length - 1][1] = frames[i];
    else spans.push([frames[i], frames[i]]);
  }
  return spans;
};

/** Which frames failed and why, as one sentence for each kind; nothing without a trace. */
hypotrack.outcomeText = function (series) {
  if (!series.outcome) return '';
  var most = 20;
  return hypotrack.wrongOutcomes.map(function (outcome) {
    var spans = hypotrack.outcomeSpans(series, outcome.letter);
    if (!spans.length) return '';
    var places = spans.slice(0, most).map(function (span) {
      return span[0] === span[1] ? span[0] : span[0] + ' to ' + span[1];
    }).join(', ');
    var more = spans.length > most ? ' and ' + (spans.length - most) + ' more places' : '';
    return 'Frames where the ' + outcome.name + ' (' + outcome.why + '): ' + places + more + '.';
  }).filter(Boolean).join(' ');
};

/** The costs of a run and, of a traced one, those of the truth and marks on frames that failed. */
hypotrack.costLines = function (series) {
  var costs = hypotrack.numbers(series.cost);
  if (!series.outcome) return [{name: 'cost', values: costs}];
  var lines = [{name: 'solution', values: costs},
               {name: 'truth', values: hypotrack.numbers(series.truth_cost)}];
  hypotrack.wrongOutcomes.forEach(function (outcome) {
    if (series.outcome.indexOf(outcome.letter) < 0) return;
    lines.push({name: outcome.name, marks: true, values: costs.map(function (cost, i) {
      return series.outcome[i] === outcome.letter ? cost : NaN;
    })});
  });
  return lines;
};

hypotrack.runPlots = function (run) {
  var series = run.series, frames = hypotrack.framesOf(series), plots = [];
  var shaded = hypotrack.lostSpans(series);
  function timeline(id, title, label, lines, zero) {
    plots.push({
      id: id, kind: 'timeline', title: title, shaded: shaded, zero: zero,
      x: {label: 'frame', values: frames}, y: {label: label}, series: lines,
    });
  }
  function line(name, packed) { return {name: name, values: hypotrack.numbers(packed)}; }
  if (series.error) {
    var names = Object.keys(series.models || {});
    var lines = [line('mean', series.error)];
    if (names.length > 1)
      names.forEach(function (name) { lines.push(line(name, series.models[name])); });
    timeline('error', 'Error over time', 'error (mm)', lines, true);
  }
  var costs = 'Cost of the solution' + (series.outcome ? ' and of the truth' : '');
  timeline('cost', costs, 'cost', hypotrack.costLines(series), false);
  timeline('time', 'Time per frame', 'time (ms)', [line('time', series.milliseconds)], true);
  if (run.success) plots.push(hypotrack.runSuccess(run.success));
  if (run.landmarks && run.landmarks.length) plots.push(hypotrack.landmarkBars(run.landmarks));
  return plots;
};

hypotrack.runSuccess = function (success) {
  return {
    id: 'success', kind: 'success', title: 'Share of frames below an error', color: null,
    x: {label: 'error threshold (mm)'}, y: {label: 'share of frames (%)'},
    facets: [{label: '', rows: success.threshold_mm.map(function (threshold, i) {
      return {x: threshold, mean: 100 * success.share[i], sd: null, n: 1};
    })}],
  };
};

hypotrack.landmarkBars = function (landmarks) {
  var known = landmarks.filter(function (entry) { return entry[1] !== null; });
  return {
    id: 'landmarks', kind: 'bars', title: 'Mean error of each landmark', color: null,
    x: {label: 'landmark', values: known.map(function (entry) { return entry[0]; })},
    y: {label: 'mean error (mm)'}, value: {label: 'mean error (mm)', digits: 2},
    facets: [{label: '', rows: known.map(function (entry) {
      return {x: entry[0], mean: entry[1], sd: null, n: 1};
    })}],
  };
};
