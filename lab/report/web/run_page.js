'use strict';
/* The page of one run. */

hypotrack.runFacts = function (page, run) {
  var order = ['mean_error_mm', 'median_error_mm', 'p95_error_mm', 'max_error_mm', 'auc_20_50',
               'success_10mm', 'success_20mm', 'found_share', 'search_failed_share',
               'objective_failed_share', 'lost_share', 'time_to_loss_s', 'jitter_mm',
               'tracked_share', 'uncertain_share', 'absent_share', 'false_tracked_share',
               'right_tracked_share', 'absent_tracked_share', 'returns', 'recovered_2_share',
               'recovered_10_share', 'frames_to_recovery', 'lost_sigma_min_mm',
               'frames', 'fps', 'evaluations_per_second'];
  var facts = [];
  order.forEach(function (key) {
    if (page.metrics[key] && run.metrics[key] !== undefined && run.metrics[key] !== null)
      facts.push([page.metrics[key].label, hypotrack.metricText(page, key, run.metrics[key])]);
  });
  facts.push(['evaluations per frame', run.series.evaluations.toFixed(0)]);
  if (run.backend) facts.push(['evaluated by', run.backend]);
  var models = Object.keys(run.models || {});
  if (models.length > 1)
    models.forEach(function (name) { facts.push([name, run.models[name].toFixed(2) + ' mm']); });
  return facts;
};

/** Overlays at the worst moments; with a replay, each leads to its frame there. */
hypotrack.worstMoments = function (run, replay) {
  if (!run.worst.length) return null;
  var frames = hypotrack.framesOf(run.series);
  var errors = run.series.error ? hypotrack.numbers(run.series.error) : null;
  return hypotrack.section('Worst moments', [
    hypotrack.element('div', {class: 'worst'}, run.worst.map(function (picture) {
      var place = frames.indexOf(picture.frame);
      var text = 'Frame ' + picture.frame;
      if (errors && place >= 0 && !isNaN(errors[place]))
        text += ': ' + errors[place].toFixed(1) + ' mm';
      function showIn3D() {
        replay.seek(picture.frame);
        replay.element.scrollIntoView({block: 'center'});
      }
      return hypotrack.element('figure', {}, [
        hypotrack.element('img', {src: picture.src,
                                  alt: text + '; solution and truth drawn over the image'}),
        hypotrack.element('figcaption', {text: text}),
        replay ? hypotrack.element('button', {type: 'button', text: 'Show in 3D',
                                              on: {click: showIn3D}}) : null,
      ]);
    })),
  ]);
};

hypotrack.neighbours = function (page, run) {
  var runs = page.runs.filter(function (other) { return !other.failed; });
  var at = runs.indexOf(run);
  function link(other, text) {
    return other ? hypotrack.element('a', {href: hypotrack.runAddress(other), text: text}) : null;
  }
  return hypotrack.element('nav', {class: 'neighbours', 'aria-label': 'Runs'}, [
    page.kind === 'study' ? hypotrack.element('a', {href: '#/', text: '← ' + page.title}) : null,
    link(runs[at - 1], 'Previous run'), link(runs[at + 1], 'Next run'),
  ]);
};

hypotrack.runPage = function (page, run) {
  var replay = run.replay ? hypotrack.replay(page, run) : null;
  var what = hypotrack.settingsText(page, run);
  var spans = hypotrack.lostSpans(run.series);
  var lost = run.series.error ? 'Shaded: target lost (tracker says so, or error above ' +
      hypotrack.lostAbove + ' mm).' : 'Shaded: the tracker says that the target is lost.';
  return {
    stop: function () { if (replay) replay.stop(); },
    element: hypotrack.element('div', {class: 'run'}, [
      page.runs.length > 1 ? hypotrack.neighbours(page, run) : null,
      hypotrack.element('h1', {tabindex: '-1', text: page.kind === 'study' ?
          what + ' · seed ' + run.seed : page.title}),
      page.kind === 'study' ? hypotrack.element('p', {class: 'about', text: run.id}) : null,
      hypotrack.facts(hypotrack.runFacts(page, run)),
      hypotrack.section('Replay', [
        replay ? replay.element
               : hypotrack.note('This run has no replay in this report. ' + page.left_out)]),
      hypotrack.worstMoments(run, replay),
      hypotrack.section('Frame by frame', hypotrack.runPlots(run).map(hypotrack.chart).concat([
        hypotrack.note(hypotrack.outcomeText(run.series)),
        hypotrack.note(spans.length ? lost : '')])),
    ]),
  };
};
