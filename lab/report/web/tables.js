'use strict';
/* Tables of a study (table_data.hpp) and the list of its runs. */

/** Rows can be sorted by a column: the heading is a button. `rows` are {cells: [...], keys: [...]}
    with an element and a sort key per column. */
hypotrack.sortableTable = function (headings, rows, caption) {
  var body = hypotrack.element('tbody'), order = {column: -1, up: true};
  var heads = headings.map(function (heading, column) {
    var button = hypotrack.element('button', {type: 'button', text: heading, on: {
      click: function () { sortBy(column); }}});
    return hypotrack.element('th', {scope: 'col'}, [button]);
  });
  function fill(list) {
    body.textContent = '';
    list.forEach(function (row) { body.appendChild(hypotrack.element('tr', {}, row.cells)); });
  }
  function sortBy(column) {
    order.up = order.column === column ? !order.up : true;
    order.column = column;
    heads.forEach(function (head, i) {
      if (i === column) head.setAttribute('aria-sort', order.up ? 'ascending' : 'descending');
      else head.removeAttribute('aria-sort');
    });
    fill(rows.slice().sort(function (a, b) {
      return (order.up ? 1 : -1) * hypotrack.compareKeys(a.keys[column], b.keys[column]);
    }));
  }
  fill(rows);
  var region = {class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption};
  var scroll = hypotrack.element('div', region, [
    hypotrack.element('table', {}, [
      hypotrack.element('caption', {class: 'hidden', text: caption}),
      hypotrack.element('thead', {}, [hypotrack.element('tr', {}, heads)]), body,
    ]),
  ]);
  var box = hypotrack.element('div', {class: 'scrolled'}, [scroll,
    hypotrack.element('p', {class: 'more', 'aria-hidden': 'true', text: 'more columns →'})]);
  scroll.addEventListener('scroll', function () { hypotrack.markWide(box); });
  return box;
};

/** Shows that a table goes on to the right, and where it goes on to the left. */
hypotrack.markWide = function (box) {
  var scroll = box.firstChild, left = scroll.scrollLeft;
  box.classList.toggle('goes-right', scroll.scrollWidth - scroll.clientWidth - left > 2);
  box.classList.toggle('goes-left', left > 2);
};

hypotrack.markWideTables = function () {
  document.querySelectorAll('.scrolled').forEach(hypotrack.markWide);
};

/** Numbers before texts before nothing. */
hypotrack.compareKeys = function (a, b) {
  var missing = function (key) { return key === null || key === undefined || key === ''; };
  if (missing(a) || missing(b)) return missing(a) - missing(b);
  if (!isNaN(a) && !isNaN(b)) return a - b;
  return String(a).localeCompare(String(b));
};

/** `12.3 ± 0.4`, the best in bold, with a sign where seeds do not separate it from the best. */
hypotrack.comparisonCell = function (cell, digits) {
  if (!cell || cell.mean === null) return hypotrack.element('td', {class: 'number', text: '–'});
  var text = cell.mean.toFixed(digits);
  var td = hypotrack.element('td', {class: 'number' + (cell.best ? ' best' : '')}, [
    hypotrack.element(cell.best ? 'strong' : 'span', {text: text}),
  ]);
  if (cell.sd !== null)
    td.appendChild(hypotrack.element('span', {class: 'sd',
                                              text: ' ± ' + cell.sd.toFixed(digits)}));
  if (cell.best) td.appendChild(hypotrack.element('span', {class: 'hidden', text: ' best'}));
  if (cell.same)
    td.appendChild(hypotrack.element('span', {class: 'same',
                                              text: ' ≈' + hypotrack.seedsText(cell, ' ')}));
  if (cell.p !== null)
    td.title = 'difference from the best: p = ' + cell.p.toPrecision(2) +
               (cell.seeds_needed ? ';' + hypotrack.seedsText(cell, ' ') +
                                    ' seeds would find it with a power of 80 %' : '');
  else if (cell.best) td.title = 'best';
  if (cell.detail) td.appendChild(hypotrack.element('div', {class: 'detail', text: cell.detail}));
  return td;
};

/** The seeds that would find a difference, after `before`; nothing where that is not known. */
hypotrack.seedsText = function (cell, before) {
  if (!cell.seeds_needed) return '';
  return before + (cell.seeds_needed > 1000 ? '>1000' : cell.seeds_needed);
};

/** The number of runs, and of those that differ where some are the same. */
hypotrack.runsText = function (row) {
  return row.samples < row.runs ? row.runs + ' (' + row.samples + ' distinct)' : String(row.runs);
};

hypotrack.comparisonTable = function (table) {
  var failures = table.rows.some(function (row) { return row.failed > 0; });
  var headings = table.keys.concat(['runs']).concat(failures ? ['failed'] : [])
      .concat(table.columns.map(function (column) { return column.label; }));
  var rows = table.rows.map(function (row) {
    var cells = row.keys.map(function (key) {
      return hypotrack.element('th', {scope: 'row', text: key});
    });
    [hypotrack.runsText(row)].concat(failures ? [row.failed] : []).forEach(function (count) {
      cells.push(hypotrack.element('td', {class: 'number', text: count}));
    });
    row.cells.forEach(function (cell, i) {
      cells.push(hypotrack.comparisonCell(cell, table.columns[i].digits));
    });
    var keys = row.keys.concat([row.runs]).concat(failures ? [row.failed] : [])
        .concat(row.cells.map(function (cell) { return cell.mean; }));
    return {cells: cells, keys: keys};
  });
  return hypotrack.element('div', {class: 'table', id: table.id}, [
    hypotrack.element('h3', {text: table.title}),
    hypotrack.sortableTable(headings, rows, table.title),
    table.identical ? hypotrack.element('p', {class: 'note warning', text: table.identical}) : null,
    hypotrack.note(table.note),
  ]);
};

hypotrack.runsTable = function (page, runs) {
  var columns = ['mean_error_mm', 'p95_error_mm', 'auc_20_50', 'lost_share', 'tracked_share',
                 'false_tracked_share', 'recovered_10_share', 'fps']
      .filter(function (key) { return page.metrics[key]; });
  var scenes = page.runs.some(function (run) { return run.scene; });
  var headings = ['run'].concat(scenes ? ['scene'] : [])
      .concat(page.axes.map(function (axis) { return axis.label; })).concat(['seed', 'replay'])
      .concat(columns.map(function (key) {
        var metric = page.metrics[key];
        return metric.unit ? metric.label + ' (' + metric.unit + ')' : metric.label;
      }));
  var rows = runs.map(function (run) {
    var texts = (scenes ? [run.scene] : []).concat(run.settings);
    var number = page.runs.indexOf(run) + 1;
    var link = hypotrack.element('a', {href: hypotrack.runAddress(run), text: number,
                                       title: run.id});
    var cells = [hypotrack.element('th', {scope: 'row'}, [link])];
    var numbers = columns.map(function (key) {
      var value = run.metrics[key];
      return value === null || value === undefined ? null : page.metrics[key].factor * value;
    });
    texts.forEach(function (text) { cells.push(hypotrack.element('td', {text: text})); });
    cells.push(hypotrack.element('td', {class: 'number', text: run.seed}));
    cells.push(hypotrack.element('td', {text: run.replay ? '3D' : ''}));
    numbers.forEach(function (value, i) {
      cells.push(hypotrack.element('td', {class: 'number', text:
        value === null ? '–' : value.toFixed(page.metrics[columns[i]].digits)}));
    });
    return {cells: cells, keys: [number].concat(texts, [run.seed, run.replay ? 0 : 1], numbers)};
  });
  return hypotrack.sortableTable(headings, rows, 'Runs');
};
