
var vega = (function () {
  var transforms = vegaModules['vega-dataflow'].transforms;
  ['vega-transforms', 'vega-view-transforms', 'vega-encode'].forEach(function (name) {
    Object.assign(transforms, vegaModules[name]);
  });
  return {
    parse: vegaModules['vega-parser'].parse,
    View: vegaModules['vega-view'].View,
  };
})();
