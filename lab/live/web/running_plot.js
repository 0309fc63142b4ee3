'use strict';
/* Plots of the last minutes. */

/** A round step of an axis that is at least `least`. */
hypotrack.roundStep = function (least) {
  var power = Math.pow(10, Math.floor(Math.log10(least)));
  return [1, 2, 5, 10].map(function (factor) { return factor * power; })
      .find(function (step) { return step >= least; });
};

/** A plot of series over time: {element, draw(samples, now)}. A series has a name, a number of a
    colour and value(sample); null is a gap. The axis ends at `top` if given, else above this
    `share` of the values. */
hypotrack.runningPlot = function (title, series, top, share) {
  var kSeconds = 120, kLeft = 54, kBottom = 20, kTop = 8;
  var canvas = hypotrack.element('canvas', {role: 'img', 'aria-label': title});
  var key = series.length < 2 ? [] : series.map(function (each) {
    return hypotrack.element('span', {class: 'key color-' + each.color % 4, text: each.name});
  });
  var element = hypotrack.element('section', {class: 'card'}, [
    hypotrack.element('h2', {text: title}, [hypotrack.element('span', {}, key)]), canvas]);
  function highestOf(shown) {
    if (top) return top;
    var values = [].concat.apply([], shown.map(function (sample) {
      return series.map(function (each) { return each.value(sample) || 0; });
    })).sort(function (a, b) { return a - b; });
    var at = Math.floor((share || 1) * (values.length - 1));
    return values.length ? hypotrack.roundStep(1.05 * Math.max(1e-3, values[at])) : 1;
  }
  function drawAxes(pen, width, height, highest, style) {
    pen.font = '11px sans-serif';
    pen.fillStyle = style.getPropertyValue('--muted');
    pen.strokeStyle = style.getPropertyValue('--line');
    var step = hypotrack.roundStep(highest / 4);
    for (var value = 0; value <= highest * 1.001; value += step) {
      var y = kTop + (height - kTop - kBottom) * (1 - value / highest);
      pen.beginPath();
      pen.moveTo(kLeft, y);
      pen.lineTo(width, y);
      pen.stroke();
      pen.textAlign = 'right';
      pen.fillText(String(+value.toPrecision(3)), kLeft - 6, y + 4);
    }
    pen.textAlign = 'left';
    pen.fillText('2 min ago', kLeft, height - 4);
    pen.textAlign = 'right';
    pen.fillText('now', width, height - 4);
  }
  function draw(samples, now) {
    var ratio = window.devicePixelRatio || 1;
    var width = canvas.clientWidth, height = canvas.clientHeight;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    var pen = canvas.getContext('2d'), style = getComputedStyle(document.documentElement);
    pen.scale(ratio, ratio);
    var shown = samples.filter(function (sample) { return sample.seconds > now - kSeconds; });
    var highest = highestOf(shown);
    drawAxes(pen, width, height, highest, style);
    series.forEach(function (each) {
      pen.strokeStyle = style.getPropertyValue('--plot-' + each.color % 4);
      pen.lineWidth = 1.6;
      pen.lineJoin = 'round';
      pen.beginPath();
      var last = null;
      shown.forEach(function (sample) {
        var value = each.value(sample);
        var known = value !== null && value !== undefined;
        if (known) {
          var x = kLeft + (width - kLeft) * (1 - (now - sample.seconds) / kSeconds);
          var y = kTop + (height - kTop - kBottom) * (1 - Math.min(value / highest, 1));
          if (last === null) pen.moveTo(x, y); else pen.lineTo(x, y);
        }
        last = known ? value : null;
      });
      pen.stroke();
    });
  }
  return {element: element, draw: draw};
};
