#!/usr/bin/env bash
# usage: rest_examples_test.sh TRIBODYND
# Runs the commands of server/REST.md, which lead from an empty database to the drawing of a curve,
# against a server on a free port.
set -euo pipefail
tribodynd=$(realpath "$1")
page=$(realpath "$(dirname "${BASH_SOURCE[0]}")/../../server/REST.md")
folder=$(mktemp -d)
cd "$folder"
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT

sed -n '/^```sh$/,/^```$/p' "$page" | sed '1d;$d' >commands
read -r -a start <<<"$(sed -n '1s/50652 &$/0/p' commands)"
[ "${start[0]}" = tribodynd ] || { echo "the first command does not start tribodynd"; exit 1; }
"$tribodynd" "${start[@]:1}" --listen 127.0.0.1:0 >log 2>&1 &
server=$!
port=
for _ in $(seq 300); do
  port=$(sed -nE 's,.*REST at http://127\.0\.0\.1:([0-9]+).*,\1,p' log)
  [ -z "$port" ] || [ "$(curl -s -o /dev/null -w '%{http_code}' "http://127.0.0.1:$port/healthz")" != 200 ] || break
  sleep 0.1
done
[ -n "$port" ] || { cat log; exit 1; }

sed "1d; s/127\.0\.0\.1:50652/127.0.0.1:$port/g" commands >rest
bash -euo pipefail rest >said 2>&1 || { cat said log; exit 1; }
grep -q '^event: end$' said || { echo "the events did not end:"; cat said; exit 1; }
[ "$(head -n 1 curve.csv)" = speed_kilometres_per_hour,inefficiency_energy_mean_percent ]
[ "$(wc -l <curve.csv)" = 14 ] || { cat curve.csv; exit 1; }
grep -q '</svg>' curve.svg
kill -TERM "$server"
wait "$server"
server=
