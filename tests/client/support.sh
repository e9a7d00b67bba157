# shellcheck shell=bash
# For the tests of the command line: starts a real tribodynd on a free port of loopback with a
# database in a temporary folder, runs the client, keeps its output in $folder/out and
# $folder/err, and counts failures. Sourced with TRIBODYND and TRIBODYN as $1 and $2.
set -uo pipefail

server=$1
client=$2
folder=$(mktemp -d)
server_pid=
failures=0

start_server() {
  rm -f "$folder/port"
  "$server" --listen 127.0.0.1:0 --database "$folder/db.sqlite" --port-file "$folder/port" "$@" \
    >>"$folder/server.log" 2>&1 &
  server_pid=$!
  until [ -s "$folder/port" ] || ! kill -0 "$server_pid" 2>/dev/null; do sleep 0.02; done
  if [ ! -s "$folder/port" ]; then
    cat "$folder/server.log"
    echo "the server did not start"
    exit 1
  fi
  TRIBODYN_SERVER=$(<"$folder/port")
  TRIBODYN_TOKEN_FILE=$folder/db.sqlite.token
  export TRIBODYN_SERVER TRIBODYN_TOKEN_FILE
}

stop_server() {
  [ -n "$server_pid" ] || return 0
  kill "$server_pid" 2>/dev/null
  for _ in $(seq 1500); do
    kill -0 "$server_pid" 2>/dev/null || break
    sleep 0.02
  done
  kill -9 "$server_pid" 2>/dev/null
  wait "$server_pid" 2>/dev/null
  server_pid=
}

cleanup() {
  stop_server
  rm -rf "$folder"
}
trap cleanup EXIT
trap 'exit 1' INT TERM

fail() {
  failures=$((failures + 1))
  echo "FAILED: $*"
  echo "  stdout: $(head -c 1500 "$folder/out")"
  echo "  stderr: $(head -c 1500 "$folder/err")"
}

# expect CODE ARGUMENTS...: runs the client, saves its output in out and err, checks the exit code.
expect() {
  local wanted=$1 code=0
  shift
  asked="$*"
  "$client" "$@" >"$folder/out" 2>"$folder/err" </dev/null || code=$?
  [ "$code" -eq "$wanted" ] || fail "tribodyn $asked: exit code $code, not $wanted"
}
# _in FILE NAME PATTERN...: each pattern is in the file.
_in() {
  local file=$1 name=$2
  shift 2
  for part; do
    grep -qE -- "$part" "$folder/$file" || fail "tribodyn $asked: no '$part' on standard $name"
  done
}
out_has() { _in out output "$@"; }
err_has() { _in err error "$@"; }
out_lacks() { ! grep -qE -- "$1" "$folder/out" || fail "tribodyn $asked: '$1' on standard output"; }
out_lines() {
  local lines
  lines=$(wc -l <"$folder/out")
  [ "$lines" -eq "$1" ] || fail "tribodyn $asked: $lines lines, not $1"
}
# Checks that every line of a CSV without quotes has as many cells as its header.
out_is_csv() {
  grep -v '"' "$folder/out" | awk -F, 'NR == 1 { n = NF } NF != n || n < 2 { bad = 1 } END { exit bad }' ||
    fail "tribodyn $asked: not a CSV table"
}
# Checks that braces and brackets balance and that the text is an object.
out_is_json() {
  awk 'NR == 1 && !/^\{/ { bad = 1 }
       { open += gsub(/[{[]/, ""); open -= gsub(/[]}]/, "") } END { exit bad || open != 0 }' \
    <(sed 's/"[^"]*"//g; 1s/^$/{/' "$folder/out") || fail "tribodyn $asked: not JSON"
}

# Ignores the configuration file of the user who runs the test.
export XDG_CONFIG_HOME=$folder/settings
unset TRIBODYN_CONFIG TRIBODYN_PROJECT TRIBODYN_TOKEN_FILE TRIBODYN_OUTPUT TRIBODYN_TIMEOUT_SECONDS TRIBODYN_PROGRESS TRIBODYN_COLOR

finish() {
  [ "$failures" -eq 0 ] || echo "$failures failures"
  [ "$failures" -eq 0 ]
}
