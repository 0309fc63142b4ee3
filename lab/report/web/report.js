'use strict';
/* Shows the overview or the run that the address names: #/ or #/run/ID. */
(function () {
  var page = JSON.parse(document.getElementById('data').textContent);
  var main = document.querySelector('main');
  var shown = null;

  function runNamed(id) {
    return page.runs.find(function (run) { return run.id === id && !run.failed; });
  }

  function content() {
    if (page.kind === 'change')
      return {element: hypotrack.changePage(page), stop: function () {}};
    var match = /^#\/run\/(.*)$/.exec(location.hash);
    var run = match ? runNamed(decodeURIComponent(match[1])) : null;
    if (!run && page.kind === 'run') run = page.runs[0];
    if (run) return hypotrack.runPage(page, run);
    return {element: hypotrack.overview(page), stop: function () {}};
  }

  function show(focus) {
    if (shown) shown.stop();
    hypotrack.forgetCharts();
    shown = content();
    main.textContent = '';
    main.appendChild(shown.element);
    var heading = main.querySelector('h1');
    var title = heading.textContent;
    document.title = title === page.title ? title : title + ' – ' + page.title;
    hypotrack.drawCharts(true);
    hypotrack.markWideTables();
    if (focus) {
      window.scrollTo(0, 0);
      heading.focus({preventScroll: true});
    }
  }

  window.addEventListener('hashchange', function () { show(true); });
  window.addEventListener('resize', function () {
    hypotrack.drawCharts(false);
    hypotrack.markWideTables();
  });
  hypotrack.dark.addEventListener('change', function () { hypotrack.drawCharts(true); });
  document.getElementById('version').textContent = 'Made by hypotrack ' + page.version;
  show(false);
})();
