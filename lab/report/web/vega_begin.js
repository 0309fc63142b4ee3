/* Vega's modules in the order in which they need each other, joined to the object `vega`. */
var vegaModules = {};

function vegaRequire(name) {
  // The one module whose file is not called as others ask for it.
  var file = name === 'vega-selections' ? 'vega-selection' : name;
  if (!vegaModules[file]) throw new Error('Vega needs its module ' + name);
  return vegaModules[file];
}

function vegaModule(name, define) {
  var module = {exports: {}};
  define.call(undefined, module.exports, module, vegaRequire);
  vegaModules[name] = module.exports;
}

