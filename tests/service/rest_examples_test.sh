#!/usr/bin/env bash
# usage: rest_examples_test.sh TRIBODYND
# Runs the two lists of commands of server/REST.md, which lead from an empty database to a curve, in
# the clear and by TLS, against servers on free ports.
set -euo pipefail
tribodynd=$(realpath "$1")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../..")
folder=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT

# run NUMBER SCHEME HOST PORT: runs a list, whose line `tribodynd ... &` starts the server, with a free
# port in place of the stated one.
run() {
  mkdir "$folder/$1"
  cd "$folder/$1"
  ln -s "$root/deploy" deploy
  awk -v list="$1" '/^```sh$/ { ++n; inside = n == list; next } /^```$/ { inside = 0 } inside' \
    "$root/server/REST.md" >commands
  sed '/^tribodynd/,$d' commands >before
  sed '0,/^tribodynd/d' commands >after
  bash -euo pipefail before
  read -r -a start <<<"$(sed -nE "/^tribodynd/s/:$4(.*) &$/:0\\1/p" commands)"
  [ "${start[0]}" = tribodynd ] || { echo "no command of list $1 starts tribodynd"; exit 1; }
  : >log  # read below, perhaps before the shell of the server has opened it
  "$tribodynd" "${start[@]:1}" --listen 127.0.0.1:0 >log 2>&1 &
  server=$!
  port=
  for _ in $(seq 300); do
    port=$(sed -nE "s,.*REST at $2://[0-9.]+:([0-9]+).*,\\1,p" log)
    [ -z "$port" ] || [ "$(curl -sk -o /dev/null -w '%{http_code}' "$2://$3:$port/healthz")" != 200 ] || break
    sleep 0.1
  done
  [ -n "$port" ] || { cat log; exit 1; }
  sed "s/127\.0\.0\.1:$4/127.0.0.1:$port/g" after >rest
  bash -euo pipefail rest >said 2>&1 || { cat said log; exit 1; }
  grep -q '^event: end$' said || { echo "the events did not end:"; cat said; exit 1; }
  [ "$(head -n 1 curve.csv)" = speed_kilometres_per_hour,inefficiency_energy_mean_percent ]
  [ "$(wc -l <curve.csv)" = 14 ] || { cat curve.csv; exit 1; }
  kill -TERM "$server"
  wait "$server"
  server=
}
run 1 http 127.0.0.1 50652
grep -q '</svg>' curve.svg
run 2 https 127.0.0.1 50653
