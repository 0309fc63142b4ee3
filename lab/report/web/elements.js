'use strict';
/* Elements from data. Texts go in as text, never as HTML. */

/** hypotrack.element('a', {href: '#', text: 'there', class: 'x'}, [children]) */
hypotrack.element = function (name, attributes, children) {
  var element = document.createElement(name);
  Object.keys(attributes || {}).forEach(function (key) {
    if (key === 'text') element.textContent = attributes[key];
    else if (key === 'on') Object.keys(attributes.on).forEach(function (event) {
      element.addEventListener(event, attributes.on[event]);
    });
    else if (attributes[key] !== undefined && attributes[key] !== null)
      element.setAttribute(key, attributes[key]);
  });
  (children || []).forEach(function (child) { if (child) element.appendChild(child); });
  return element;
};

hypotrack.section = function (title, children) {
  var heading = hypotrack.element('h2', {text: title});
  return hypotrack.element('section', {}, [heading].concat(children));
};

hypotrack.note = function (text) {
  return text ? hypotrack.element('p', {class: 'note', text: text}) : null;
};

/** A list of values with their names. */
hypotrack.facts = function (facts) {
  return hypotrack.element('dl', {class: 'facts'}, facts.map(function (fact) {
    return hypotrack.element('div', {}, [
      hypotrack.element('dt', {text: fact[0]}), hypotrack.element('dd', {text: fact[1]}),
    ]);
  }));
};

/** A metric of a run with its unit; a dash where it has none. */
hypotrack.metricText = function (page, key, value) {
  if (value === null || value === undefined) return '–';
  var metric = page.metrics[key];
  var text = (metric.factor * value).toFixed(metric.digits);
  return metric.unit ? text + ' ' + metric.unit : text;
};

hypotrack.runAddress = function (run) { return '#/run/' + encodeURIComponent(run.id); };

/** What sets a run apart: its scene and settings. */
hypotrack.settingsText = function (page, run) {
  var parts = run.scene ? [run.scene] : [];
  page.axes.forEach(function (axis, i) {
    if (run.settings[i] !== '') parts.push(axis.label + ' ' + run.settings[i]);
  });
  return parts.join(' · ');
};
