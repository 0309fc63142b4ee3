'use strict';
/* The page of a study before and after a change (change_data.hpp). */

/** `12.3 → 11.8`, and below it the difference with what the test says of it. */
hypotrack.changeCell = function (cell, digits) {
  if (cell.before === null || cell.after === null)
    return hypotrack.element('td', {class: 'number', text: '–'});
  var sign = cell.difference > 0 ? '+' : cell.difference < 0 ? '−' : '±';
  var text = sign + Math.abs(cell.difference).toFixed(digits);
  if (cell.sd) text += ' ± ' + cell.sd.toFixed(digits);
  if (cell.verdict === 'open') text += ' ≈' + hypotrack.seedsText(cell, ' ');
  else if (cell.verdict) text += ' ' + cell.verdict;
  return hypotrack.element('td', {
    class: 'number ' + cell.verdict, title: cell.p === null ? '' : 'p = ' + cell.p.toPrecision(2),
  }, [
    hypotrack.element('span', {text: cell.before.toFixed(digits) + ' → ' +
                                     cell.after.toFixed(digits)}),
    hypotrack.element('div', {class: 'detail', text: text}),
  ]);
};

hypotrack.changeTable = function (table) {
  var headings = table.keys.concat(['samples'])
      .concat(table.columns.map(function (column) { return column.label; }));
  var rows = table.rows.map(function (row) {
    var cells = row.keys.map(function (key) {
      return hypotrack.element('th', {scope: 'row', text: key});
    });
    var samples = row.before === row.after ? String(row.before) : row.before + ' → ' + row.after;
    cells.push(hypotrack.element('td', {class: 'number', text: samples}));
    row.cells.forEach(function (cell, i) {
      cells.push(hypotrack.changeCell(cell, table.columns[i].digits));
    });
    return {cells: cells, keys: row.keys.concat([row.after]).concat(row.cells.map(function (cell) {
      return cell.difference;
    }))};
  });
  return hypotrack.element('div', {class: 'table', id: table.id}, [
    hypotrack.element('h3', {text: table.title}),
    hypotrack.sortableTable(headings, rows, table.title),
    hypotrack.note(table.note),
  ]);
};

hypotrack.changePage = function (page) {
  return hypotrack.element('div', {class: 'overview'}, [
    hypotrack.element('h1', {tabindex: '-1', text: page.title}),
    page.about ? hypotrack.element('p', {class: 'about', text: page.about}) : null,
    hypotrack.facts(page.facts),
    hypotrack.note(page.left_out),
    hypotrack.section('Before and after', page.tables.map(hypotrack.changeTable)),
  ]);
};
