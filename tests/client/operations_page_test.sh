#!/usr/bin/env bash
# Runs the commands of deploy/OPERATIONS.md: a server with TLS on one side, a client with its authority
# and a token on the other, in folders of their own.
# usage: operations_page_test.sh TRIBODYND TRIBODYN DEPLOY_FOLDER
set -euo pipefail
folder=$(mktemp -d)
server_pid=
cleanup() {
  [ -z "$server_pid" ] || kill "$server_pid" 2>/dev/null || true
  wait 2>/dev/null || true
  rm -rf "$folder"
}
trap cleanup EXIT
trap 'exit 1' INT TERM
mkdir "$folder/programs" "$folder/server" "$folder/client"
ln -s "$1" "$2" "$folder/programs/"
ln -s "$3" "$folder/server/deploy"
export PATH=$folder/programs:$PATH XDG_CONFIG_HOME=$folder/client
unset TRIBODYN_SERVER TRIBODYN_TOKEN_FILE TRIBODYN_CONFIG TRIBODYN_PROJECT
mapfile -t ports < <(shuf -i 20000-29999 -n 2)
local_port=${ports[0]} remote_port=${ports[1]}
sed -n 's/^    //p' "$3/OPERATIONS.md" |
  sed "s/axles\.example\.com/localhost/g; s/50651/$local_port/g; s/50652/$remote_port/g" >"$folder/page"

# The server's commands are those before the first export.
cd "$folder/server"
sed '/^export /,$d' "$folder/page" >"$folder/server.sh"
echo 'echo $! >server.pid' | sed -i '/ &$/r /dev/stdin' "$folder/server.sh"
echo 'until [ -s tribodyn.sqlite.token ]; do sleep 0.1; done' | sed -i '/ &$/r /dev/stdin' "$folder/server.sh"
timeout 60 bash -eu "$folder/server.sh" >"$folder/server.log" 2>&1 ||
  { cat "$folder/server.sh" "$folder/server.log"; exit 1; }
server_pid=$(<server.pid)

cd "$folder/client"
cp ../server/certificates/ca.pem ../server/anna.token .
sed -n '/^export /,$p' "$folder/page" >"$folder/client.sh"
timeout 120 bash -eu "$folder/client.sh" || { cat "$folder/client.sh" "$folder/server.log"; exit 1; }
[ -s curve.svg ] || { echo "no curve"; exit 1; }

# A lost laptop: one command closes it.
(cd ../server && tribodynd tokens revoke anna --database tribodyn.sqlite)
if TRIBODYN_SERVER=localhost:$remote_port TRIBODYN_CA_FILE=ca.pem TRIBODYN_TOKEN_FILE=anna.token \
  tribodyn lubricants list >list 2>&1 || ! grep -q UNAUTHENTICATED list; then
  echo "the revoked token still opens something: $(cat list)"
  exit 1
fi
