'use strict';
/* The page's own functions, and the numbers that C++ packed (packed.hpp). */
var hypotrack = {};

hypotrack.bytes = function (text) {
  var binary = atob(text);
  var bytes = new Uint8Array(binary.length);
  for (var i = 0; i < binary.length; i++) bytes[i] = binary.charCodeAt(i);
  return bytes;
};

hypotrack.words = function (text) {
  var view = new DataView(hypotrack.bytes(text).buffer);
  var words = new Uint16Array(view.byteLength / 2);
  for (var i = 0; i < words.length; i++) words[i] = view.getUint16(2 * i, true);
  return words;
};

hypotrack.longs = function (text) {
  var view = new DataView(hypotrack.bytes(text).buffer);
  var longs = new Uint32Array(view.byteLength / 4);
  for (var i = 0; i < longs.length; i++) longs[i] = view.getUint32(4 * i, true);
  return longs;
};

/** {b, lo, step} to numbers; NaN where unknown. */
hypotrack.numbers = function (packed) {
  var words = hypotrack.words(packed.b);
  var numbers = new Float64Array(words.length);
  for (var i = 0; i < words.length; i++)
    numbers[i] = words[i] === 65535 ? NaN : packed.lo + packed.step * words[i];
  return numbers;
};

/** Frame numbers of a run's series. */
hypotrack.framesOf = function (series) {
  if (series.frames) return series.frames;
  return Array.from({length: series.count}, function (unused, i) { return i; });
};
