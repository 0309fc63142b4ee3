#!/usr/bin/env bash
# abidiff compares what the debug information of two libraries holds. GCC writes no more than a declaration of a class
# with virtual functions into files without its virtual table. So abidiff ends with 0, and says nothing, after a virtual
# function and a member were put before the others of an interface, if one function takes it and its own functions are
# elsewhere. With -femit-class-debug-always it tells both.
set -euo pipefail

need() { # PACKAGE VERSION: Debian's package of this version, or exit 77
  local installed
  installed=$(dpkg-query -W -f '${Version}' "$1" 2>/dev/null || true)
  case $installed in
    "$2"*) echo "$1 $installed" ;;
    *) echo "missing: $1 $2" && exit 77 ;;
  esac
}
need g++ 4:12
need abigail-tools 2.2

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
cat >interface.cpp <<'END'
class Source {
 public:
  virtual ~Source();
#ifdef LATER
  virtual int added();
  int member;
#endif
  virtual int next();
};
void take(Source*) {}
END
for flags in "" "-femit-class-debug-always"; do
  # shellcheck disable=SC2086  # none or one
  g++ -g -fPIC -shared $flags interface.cpp -o before.so
  # shellcheck disable=SC2086
  g++ -g -fPIC -shared $flags -DLATER interface.cpp -o after.so
  code=0
  abidiff before.so after.so >said.txt || code=$?
  echo "$code" >>codes.txt
  echo "${flags:-without a flag}: abidiff ends with $code and writes $(wc -l <said.txt) lines"
done
echo "expected: a change, 4 or more, both times; seen: $(paste -sd , codes.txt)"
[ "$(head -n 1 codes.txt)" = 0 ] && [ "$(tail -n 1 codes.txt)" -ge 4 ]
