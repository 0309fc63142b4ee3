'use strict';
/* node render_plots.js DATA.json FOLDER: the plots of a report as FOLDER/<id>.svg. */
var fs = require('fs');
var path = require('path');
var vm = require('vm');

['vega.js', 'decode.js', 'plot_parts.js', 'plots.js', 'run_plots.js'].forEach(function (name) {
  var file = path.join(__dirname, name);
  vm.runInThisContext(fs.readFileSync(file, 'utf8'), {filename: file});
});

async function main(dataFile, folder) {
  var page = JSON.parse(fs.readFileSync(dataFile, 'utf8'));
  var plots = page.kind === 'run' ? hypotrack.runPlots(page.runs[0]) : page.plots;
  for (var plot of plots.filter(hypotrack.hasRows)) {
    var spec = hypotrack.plotSpec(plot, {
      width: 960, theme: hypotrack.themes.light, still: true,
    });
    if (plot.title) spec.title = {text: plot.title, fontSize: 16, offset: 12};
    var view = new vega.View(vega.parse(spec), {renderer: 'none'});
    fs.writeFileSync(path.join(folder, plot.id + '.svg'), await view.toSVG());
  }
}

main(process.argv[2], process.argv[3]).catch(function (error) {
  console.error(error.stack || String(error));
  process.exit(1);
});
