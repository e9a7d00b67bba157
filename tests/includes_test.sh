#!/usr/bin/env bash
# Checks the includes of core, server and client/cpp. The table in the README.md of each lists its
# folders, the lowest first: a source includes only its own and lower folders, and nothing of the
# components that its own must not depend on. Also checks that it refuses each kind of mistake.
set -euo pipefail
shopt -s inherit_errexit
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# mistakes COMPONENT OTHERS: prints FILE:LINE and what is wrong there. OTHERS: a pattern of the other
# components that it may include. A header beside the folders belongs to the lowest folder, main.cpp
# to the highest.
mistakes() {
  find "$1" -name '*.h' -o -name '*.cpp' | sort | xargs awk -v component="$1/" -v others="^($2)/" '
    function wrong(text) { print FILENAME ":" FNR ": " text }
    FILENAME == component "README.md" {
      if (/^\| `[a-z_]+` +\|/) {
        split($0, cell, "`")
        height[cell[2]] = ++count
        row[cell[2]] = FNR
      }
      next
    }
    FNR == 1 {
      split(substr(FILENAME, length(component) + 1), part, "/")
      own = part[1]
      has_sources[own] = 1
      if (own ~ /\.h$/) height[own] = 1
      if (own ~ /\.cpp$/) height[own] = count
      if (!(own in height)) wrong(component "README.md does not list the folder " own)
    }
    /^ *# *include "/ {
      split($0, quoted, "\"")
      path = quoted[2]
      sub(/^tribodyn\/client\//, "client/cpp/include/&", path)
      if (index(path, component) == 1) {
        split(substr(path, length(component) + 1), part, "/")
        if (part[1] in height && height[part[1]] > height[own])
          wrong(own " includes the higher folder " part[1])
      } else if (path !~ others)
        wrong(component " must not include " path)
    }
    END {
      for (each in row) if (!(each in has_sources))
        print component "README.md:" row[each] ": lists the folder " each ", which has no sources"
    }
  ' "$1/README.md"
}
all_mistakes() {
  mistakes core none
  mistakes server 'core|proto|tribodyn/(internal/)?v1|google'
  mistakes client/cpp 'core|proto|tribodyn/v1|google'
}
found=$(all_mistakes)
[ -z "$found" ] || { printf '%s\n' "$found" >&2; exit 1; }

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
cd "$tree"
# refused FILE TEXT MISTAKE: checks what is said of a small tree with this file.
refused() {
  rm -rf core server client
  mkdir -p core/{low,high} server/{low,high} client/cpp/{include,high}
  printf '| `low` | |\n| `high` | |\n' | tee core/README.md >server/README.md
  printf '| `include` | |\n| `high` | |\n' >client/cpp/README.md
  echo '#pragma once' | tee {core,server}/{low,high}/a.h client/cpp/include/a.h >client/cpp/high/a.h
  printf '#include "tribodyn/client/a.h"\n#include "core/low/a.h"\n' >client/cpp/failure.h
  printf '#include "server/high/a.h"\n#include "proto/a.h"\n' >server/main.cpp
  found=$(all_mistakes)
  [ -z "$found" ] || { printf 'the small tree has mistakes: %s\n' "$found"; exit 1; }
  mkdir -p "$(dirname "$1")"
  printf '%s\n' "$2" >"$1"
  found=$(all_mistakes)
  [ "$found" = "$3" ] || { printf '%s with %s: expected "%s", found "%s"\n' "$@" "$found"; exit 1; }
}
refused client/cpp/include/b.h $'\n#include "client/cpp/high/a.h"' \
  'client/cpp/include/b.h:2: include includes the higher folder high'
refused core/beside.h '#include "core/high/a.h"' \
  'core/beside.h:1: beside.h includes the higher folder high'
refused server/cellar/a.h '' 'server/cellar/a.h:1: server/README.md does not list the folder cellar'
refused core/README.md $'| `low` | |\n| `attic` | |\n| `high` | |' \
  'core/README.md:2: lists the folder attic, which has no sources'
refused core/low/b.h '#include "proto/a.h"' 'core/low/b.h:1: core/ must not include proto/a.h'
refused server/low/b.h '#include "tribodyn/client/a.h"' \
  'server/low/b.h:1: server/ must not include client/cpp/include/tribodyn/client/a.h'
refused client/cpp/high/b.cpp '#include "server/low/a.h"' \
  'client/cpp/high/b.cpp:1: client/cpp/ must not include server/low/a.h'
