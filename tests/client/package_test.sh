#!/usr/bin/env bash
# Makes the package of the command line, unpacks it, and computes a curve with what it holds.
# usage: package_test.sh BUILD_FOLDER TRIBODYND
set -euo pipefail
folder=$(mktemp -d)
server=
trap '[ -z "$server" ] || kill "$server"; rm -rf "$folder"' EXIT
cpack --config "$1/CPackConfig.cmake" -B "$folder/made" >"$folder/log" 2>&1 ||
  { cat "$folder/log"; exit 1; }
package=("$folder"/made/*.deb)
[ ${#package[@]} = 1 ] || { echo "not one package: ${package[*]}"; exit 1; }

[ "$(dpkg-deb --field "${package[0]}" Package)" = tribodyn ]
dpkg-deb --field "${package[0]}" Depends | grep -q 'libgrpc++' ||
  { echo "the package does not say what it needs"; exit 1; }
[ "$(dpkg-deb --contents "${package[0]}" | grep -c '^-')" = 1 ] ||
  { echo "the package holds more than the command line:"; dpkg-deb --contents "${package[0]}"; exit 1; }
dpkg-deb -x "${package[0]}" "$folder/installed"
tribodyn=$folder/installed/usr/bin/tribodyn
"$tribodyn" --help | grep -q curve

"$2" --database "$folder/oils.sqlite" --listen "unix:$folder/socket" --port-file "$folder/port" \
  >"$folder/log" 2>&1 &
server=$!
for _ in $(seq 300); do
  [ ! -s "$folder/port" ] || break
  sleep 0.1
done
export XDG_CONFIG_HOME=$folder TRIBODYN_SERVER=unix:$folder/socket
unset TRIBODYN_TOKEN_FILE TRIBODYN_CONFIG TRIBODYN_PROJECT
"$tribodyn" curve --lubricant paper-fluid-1 --plot "$folder/curve.svg" >"$folder/said" 2>&1 ||
  { cat "$folder/said" "$folder/log"; exit 1; }
grep -q '</svg>' "$folder/curve.svg"
kill -TERM "$server"
wait "$server"
server=
