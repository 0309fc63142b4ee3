'use strict';
/* The controls of a replay: play, scrub, what to show. */

/** {element, seek(frame number), stop()} */
hypotrack.replay = function (page, run) {
  var stage = hypotrack.stage(page, run.replay);
  if (!stage) {
    return {element: hypotrack.element('p', {class: 'note', text:
                'The replay needs WebGL, which this browser does not offer.'}),
            seek: function () {}, stop: function () {}};
  }
  var frames = run.replay.frames, at = 0, playing = false, start = null;
  var perSecond = hypotrack.frameRate(run.series);
  var say = hypotrack.frameText(run);
  var output = hypotrack.element('output');
  var slider = hypotrack.element('input', {type: 'range', min: 0, max: frames.length - 1, value: 0,
    'aria-label': 'Frame', on: {input: function () { play(false); show(Number(slider.value)); }}});
  var button = hypotrack.element('button', {type: 'button', text: 'Play', on: {
    click: function () { play(!playing); }}});

  function show(index) {
    at = index;
    slider.value = index;
    slider.setAttribute('aria-valuetext', say(frames[index]));
    output.textContent = say(frames[index]);
    stage.show(index);
  }
  function play(on) {
    playing = on;
    button.textContent = on ? 'Pause' : 'Play';
    if (!on) return;
    if (at === frames.length - 1) show(0);
    start = null;
    requestAnimationFrame(step);
  }
  function step(now) {
    if (!playing) return;
    if (start === null) start = now - 1000 * (frames[at] - frames[0]) / perSecond;
    var due = frames[0] + (now - start) / 1000 * perSecond, next = at;
    while (next + 1 < frames.length && frames[next + 1] <= due) next++;
    if (next !== at) show(next);
    if (at === frames.length - 1) play(false);
    else requestAnimationFrame(step);
  }
  var element = hypotrack.replayElement(stage, [button, slider, output,
    hypotrack.element('button', {type: 'button', text: 'Reset view', on: {
      click: function () { stage.reset(at); }}})]);
  var fresh = true;
  var observer = new ResizeObserver(function () {
    stage.resize();
    if (fresh) stage.reset(at);  // the shape of the view is known now
    fresh = false;
  });
  observer.observe(stage.canvas.parentNode);
  stage.reset(0);
  show(0);
  return {
    element: element,
    seek: function (frame) {
      var nearest = 0;
      frames.forEach(function (each, i) {
        if (Math.abs(each - frame) < Math.abs(frames[nearest] - frame)) nearest = i;
      });
      play(false);
      show(nearest);
    },
    stop: function () { playing = false; observer.disconnect(); stage.dispose(); },
  };
};

/** Frames per second of a recording, by its times. */
hypotrack.frameRate = function (series) {
  var times = hypotrack.numbers(series.time), frames = hypotrack.framesOf(series);
  var last = times.length - 1, seconds = times[last] - times[0];
  return seconds > 0 ? (frames[last] - frames[0]) / seconds : 30;
};

/** What is said about a frame: its number and error. */
hypotrack.frameText = function (run) {
  var frames = hypotrack.framesOf(run.series), place = {};
  var errors = run.series.error ? hypotrack.numbers(run.series.error) : null;
  frames.forEach(function (frame, i) { place[frame] = i; });
  return function (frame) {
    var error = errors ? errors[place[frame]] : NaN;
    return 'frame ' + frame + (isNaN(error) ? '' : ', ' + error.toFixed(1) + ' mm');
  };
};

/** The view with its controls; a box to tick for each group that there is. */
hypotrack.replayElement = function (stage, controls) {
  var names = {tracked: 'tracked', truth: 'truth', skeleton: 'joints'};
  var boxes = Object.keys(names).filter(function (name) { return stage.groups[name].length; })
      .map(function (name) {
        var box = hypotrack.element('input', {type: 'checkbox', on: {
          change: function () { stage.setVisible(name, box.checked); }}});
        box.checked = name !== 'skeleton';
        stage.setVisible(name, box.checked);
        var key = name === 'skeleton' ? {} : {class: 'key', style: '--key: var(--' + name + ')'};
        return hypotrack.element('label', {}, [
          box, hypotrack.element('span', Object.assign({text: ' ' + names[name]}, key))]);
      });
  return hypotrack.element('div', {class: 'replay'}, [
    hypotrack.element('div', {class: 'stage'}, [stage.canvas]),
    hypotrack.element('div', {class: 'controls'}, controls),
    hypotrack.element('div', {class: 'controls'}, boxes.concat([
      hypotrack.element('span', {class: 'note', text: 'Drag to turn, scroll or pinch to zoom.'})])),
  ]);
};
