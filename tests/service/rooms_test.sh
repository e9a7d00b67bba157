#!/usr/bin/env bash
# Checks that deploy/draw-rooms --check refuses a tree whose rooms differ from server/README.md or
# core/README.md, include a higher room, or differ from the drawing.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
deploy/draw-rooms --check

tree=$(mktemp -d)
trap 'rm -rf "$tree"' EXIT
# refused CHANGE COMPLAINT: checks that --check makes the complaint about a changed copy of the
# tree.
refused() {
  rm -rf "${tree:?}"/*
  mkdir "$tree/deploy"
  cp deploy/draw-rooms "$tree/deploy"
  cp -r server core "$tree"
  (cd "$tree" && eval "$1")
  local said
  if said=$("$tree/deploy/draw-rooms" --check 2>&1); then
    echo "not refused: $1"
    exit 1
  fi
  [[ $said == *"$2"* ]] || { printf 'after %s, "%s" is not in: %s\n' "$1" "$2" "$said"; exit 1; }
}
refused 'sed -i "1i #include \"server/application/errors.h\"" server/storage/store.cpp' \
  'server/storage/store.cpp:1: storage includes the higher room application'
refused 'mkdir server/cellar; touch server/cellar/wine.h' 'does not list the room server/cellar'
refused 'rm -r server/metrics' 'server/metrics has no sources'
refused 'sed -i "1i #include \"server/support/sha256.h\"" server/daemon/daemon.cpp' 'run deploy/draw-rooms'
refused 'sed -i "1i #include \"core/periodic/shooting.h\"" core/integrate/mesh_grid.cpp' \
  'core/integrate/mesh_grid.cpp:1: integrate includes the higher room periodic'
refused 'sed -i "1i #include \"core/gear/gear_set.h\"" core/model_options.h' \
  'core/model_options.h:1: numerics includes the higher room gear'
refused 'mkdir core/dynamics; touch core/dynamics/motion.h' 'does not list the room core/dynamics'
