# Joins Vega's modules to one script: each in a function of its own, with the `require` that
# vega_begin.js defines.
file(READ ${WEB}/vega_begin.js begin)
file(WRITE ${OUT}.partial "${begin}")
foreach(module IN LISTS MODULES)
  file(READ ${VEGA}/vega-${module}.min.js text)
  string(REGEX REPLACE "//# sourceMappingURL=[^\n]*" "" text "${text}")
  file(APPEND ${OUT}.partial "vegaModule('vega-${module}', function (exports, module, require) {\n")
  file(APPEND ${OUT}.partial "${text}")
  file(APPEND ${OUT}.partial "\n});\n")
endforeach()
file(READ ${WEB}/vega_end.js end)
file(APPEND ${OUT}.partial "${end}")
file(RENAME ${OUT}.partial ${OUT})
