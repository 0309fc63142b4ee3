'use strict';
/* The live view: shows what LiveServer (live_server.hpp) sends and passes on the buttons. */
(function () {
  var kMostSamples = 3000, kSampled = 0.1, kAttempts = 3;
  var byId = function (id) { return document.getElementById(id); };
  var samples = [], plots = [], stage = null, motions = [], modelRows = [];
  var frames = null, newest = null, drawn = false, ended = false;

  function numberText(value, digits, unit) {
    return value === null || value === undefined ? '–' : value.toFixed(digits) + (unit || '');
  }

  function showNoConnection() {
    byId('run').textContent = 'no connection';
    byId('run').className = 'badge broken';
  }

  /** Sends a command, again if its connection broke. */
  function post(command, attempts) {
    fetch(command, {method: 'POST'}).catch(function () {
      if (attempts === 0) return showNoConnection();
      setTimeout(function () { post(command, attempts - 1); }, 200);
    });
  }

  function connectPictures() {
    var narrow = window.matchMedia('(max-width: 800px)'), image = byId('pictures');
    function connect() {
      if (!ended) image.src = 'pictures/' + (narrow.matches ? 'column' : 'row') + '?' + Date.now();
    }
    image.addEventListener('error', function () { setTimeout(connect, 1000); });
    narrow.addEventListener('change', connect);
    connect();
  }

  /** The expected error as a bar on an axis of millimetres. */
  function errorBar(sigma) {
    var kWidth = 300, kMost = 20;
    var x = function (mm) { return 4 + (kWidth - 30) * Math.min(mm / kMost, 1); };
    var make = function (name, attributes, text) {
      var element = document.createElementNS('http://www.w3.org/2000/svg', name);
      Object.keys(attributes).forEach(function (key) {
        element.setAttribute(key, attributes[key]);
      });
      if (text) element.textContent = text;
      return element;
    };
    var svg = make('svg', {viewBox: '0 0 ' + kWidth + ' 22', role: 'img',
                           preserveAspectRatio: 'xMinYMid',
                           'aria-label': 'Expected error ' + numberText(sigma, 1, ' mm')});
    svg.appendChild(make('path', {d: 'M4 8H' + x(kMost)}));
    [0, 5, 10, 15, 20].forEach(function (mm) {
      svg.appendChild(make('path', {d: 'M' + x(mm) + ' 5V11'}));
      svg.appendChild(make('text', {x: x(mm), y: 21, 'text-anchor': mm ? 'middle' : 'start'},
                           mm === kMost ? mm + ' mm' : String(mm)));
    });
    if (sigma !== null) {
      var end = x(sigma);
      svg.appendChild(make('path', {class: 'bar', d: 'M4 8H' + end + 'M' + end + ' 4V12'}));
      svg.appendChild(make('circle', {cx: 4, cy: 8, r: 3}));
    }
    return svg;
  }

  function showModel(row, model) {
    row.status.textContent = model.status;
    row.status.className = 'badge ' + model.status;
    row.meter.value = model.probability === null ? 0 : model.probability;
    row.probability.textContent = 'probability of being right ' + numberText(model.probability, 2);
    row.sigma.textContent = 'expected error ' + numberText(model.sigma_mm, 1, ' mm');
    var bar = errorBar(model.sigma_mm);
    row.bar.replaceWith(bar);
    row.bar = bar;
    row.sigma.hidden = model.sigma_mm === null;
    if (model.sigma_mm === null) bar.setAttribute('hidden', '');
  }

  function makeModelRow(name) {
    var row = {
      status: hypotrack.element('span', {class: 'badge'}),
      meter: hypotrack.element('meter', {min: 0, max: 1, low: 0.2, high: 0.5, optimum: 1,
                                         'aria-label': 'probability of being right'}),
      probability: hypotrack.element('span', {class: 'numbers'}),
      sigma: hypotrack.element('span', {class: 'numbers'}),
      bar: errorBar(null),
    };
    byId('models').appendChild(hypotrack.element('div', {class: 'model'}, [
      hypotrack.element('div', {}, [hypotrack.element('strong', {text: name}), row.status]),
      row.probability, row.meter, row.sigma, row.bar]));
    return row;
  }

  function makePlots(names) {
    var ofModels = function (key) {
      return names.map(function (name, i) {
        return {name: name, color: i, value: function (sample) { return sample[key][i]; }};
      });
    };
    var truth = {name: 'true', color: 3, value: function (sample) { return sample.error_mm; }};
    plots = [
      hypotrack.runningPlot('Probability of being right', ofModels('probability'), 1),
      hypotrack.runningPlot('Error, mm', ofModels('sigma_mm').map(function (each) {
        return {name: each.name + ' expected', color: each.color, value: each.value};
      }).concat(truth)),
      hypotrack.runningPlot('Milliseconds per frame', [
        {name: '', color: 1, value: function (sample) { return sample.milliseconds; }}],
        undefined, 0.98),
    ];
    plots.forEach(function (plot) { byId('plots').appendChild(plot.element); });
  }

  function makeStage(models) {
    motions = models.map(function (model) { return Object.assign({live: true}, model.motion); });
    stage = hypotrack.stage(
        {shapes: models.map(function (model) { return model.shape; }), motions: motions},
        {models: models.map(function (model, i) { return {shape: i, tracked: i}; })});
    if (!stage) return void (byId('stage').textContent = 'This browser has no WebGL.');
    byId('stage').appendChild(stage.canvas);
    byId('whole').addEventListener('click', function () { stage.reset(0); });
    new ResizeObserver(function () { stage.resize(); }).observe(byId('stage'));
    stage.resize();
  }

  /** A motion without a known place. */
  function unknown(motion) {
    return motion.p ? {p: motion.p.map(function () { return NaN; })} : {t: []};
  }

  /** Leaves out lost models; if all are, the last poses stay. */
  function showMotions(models) {
    var lost = models.map(function (model) {
      return model.status === 'lost' || model.status === 'absent';
    });
    if (drawn && lost.every(Boolean)) return;
    models.forEach(function (model, i) {
      Object.assign(motions[i], lost[i] ? unknown(model.motion) : model.motion);
    });
    stage.show(0);
    if (!drawn) stage.reset(0);
    drawn = !lost.every(Boolean);
  }

  function makeScene(scene) {
    frames = scene.frames;
    scene.models.forEach(function (model) { modelRows.push(makeModelRow(model.name)); });
    makePlots(scene.models.map(function (model) { return model.name; }));
  }

  function remember(state) {
    var last = samples[samples.length - 1];
    if (last && state.seconds - last.seconds < kSampled) return;
    var of = function (key) { return state.models.map(function (model) { return model[key]; }); };
    samples.push({seconds: state.seconds, milliseconds: state.milliseconds,
                  error_mm: state.error_mm, probability: of('probability'),
                  sigma_mm: of('sigma_mm')});
    if (samples.length > kMostSamples) samples.shift();
  }

  function showFacts(state) {
    var facts = hypotrack.facts([
      ['Frame', state.frame + (frames ? ' of ' + frames : '')],
      ['Status', state.status],
      ['Speed', numberText(state.fps, 1, ' fps')],
      ['Time per frame', numberText(state.milliseconds, 0, ' ms')],
      ['Recording', numberText(state.time, 2, ' s')],
      ['True error', numberText(state.error_mm, 1, ' mm')],
    ]);
    facts.id = 'facts';
    byId('facts').replaceWith(facts);
    facts.children[1].lastChild.className = state.status;
  }

  function showRun(state) {
    ended = state.run === 'ended';
    byId('run').textContent = {waits: 'opening the scene', runs: 'running', paused: 'paused',
                               ended: 'the run has ended'}[state.run];
    byId('run').className = 'badge ' + state.run;
    byId('pause').textContent = state.run === 'paused' ? 'Resume' : 'Pause';
    byId('text').textContent = state.text;
    byId('text').hidden = !state.text;
    ['pause', 'step', 'restart', 'snapshot'].forEach(function (id) {
      byId(id).disabled = ended || state.run === 'waits';
    });
  }

  function show() {
    if (!newest) return;
    var state = newest;
    newest = null;
    showRun(state);
    if (!state.models) return;
    showFacts(state);
    state.models.forEach(function (model, i) { showModel(modelRows[i], model); });
    if (stage) showMotions(state.models);
    plots.forEach(function (plot) { plot.draw(samples, state.seconds); });
  }

  function connectStates() {
    var events = new EventSource('events');
    events.onmessage = function (message) {
      newest = JSON.parse(message.data);
      if (newest.models && newest.run !== 'ended') remember(newest);
      if (newest.run === 'ended') events.close();
      requestAnimationFrame(show);
    };
    events.onerror = showNoConnection;
  }

  function load(address) {
    return fetch(address).then(function (answer) { return answer.json(); });
  }

  /** Waits until the scene is open. */
  function whenOpen() {
    return load('scene').then(function (scene) {
      if (scene.models) return scene;
      byId('run').textContent = 'opening the scene';
      return new Promise(function (done) { setTimeout(done, 500); }).then(whenOpen);
    });
  }

  byId('pause').addEventListener('click', function () {
    post(byId('pause').textContent === 'Pause' ? 'pause' : 'resume', kAttempts);
  });
  ['step', 'restart', 'snapshot'].forEach(function (command) {
    byId(command).addEventListener('click', function () { post(command, kAttempts); });
  });
  whenOpen().then(function (scene) {
    makeScene(scene);
    makeStage(scene.models);
    connectPictures();
    return load('history');
  }).then(function (history) {
    samples = history.samples;
    connectStates();
  }).catch(function (error) {
    showNoConnection();
    throw error;
  });
})();
