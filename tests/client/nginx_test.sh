#!/usr/bin/env bash
# Runs deploy/nginx.conf in front of a tribodynd on loopback: REST, events and gRPC pass by TLS, and
# old protocols, foreign origins and calls without a token do not.
# usage: nginx_test.sh TRIBODYND TRIBODYN DEPLOY_FOLDER
set -euo pipefail
folder=$(mktemp -d)
server= proxy=
trap '[ -z "$proxy" ] || kill "$proxy"; [ -z "$server" ] || kill "$server"; wait; rm -rf "$folder"' EXIT
cd "$folder"
"$3/make-certificates" certificates axles.example.com localhost
"$1" --database oils.sqlite --listen 127.0.0.1:0 --port-file port --http-listen 127.0.0.1:0 >log 2>&1 &
server=$!
for _ in $(seq 300); do
  [ ! -s port ] || break
  sleep 0.1
done
rpc=$(sed 's/.*://' port)
rest=$(sed -nE 's,.*REST at http://127\.0\.0\.1:([0-9]+).*,\1,p' log)
read -r https grpcs http <<<"$(shuf -i 30000-32000 -n 3 | tr '\n' ' ')"
{
  echo "pid $folder/nginx.pid; events {} http { access_log off;"
  for kind in client_body proxy fastcgi uwsgi scgi; do echo "${kind}_temp_path $folder/$kind;"; done
  sed "s,/etc/tribodyn,$folder,; s/listen 443/listen 127.0.0.1:$https/; s/listen 80;/listen 127.0.0.1:$http;/; s/listen 8443/listen 127.0.0.1:$grpcs/
    s/:50652/:$rest/; s/:50651/:$rpc/" "$3/nginx.conf"
  echo '}'
} >nginx.conf
/usr/sbin/nginx -p "$folder" -e "$folder/nginx.log" -c "$folder/nginx.conf" -g 'daemon off;' &
proxy=$!
token="Authorization: Bearer $(cat oils.sqlite.token)"
url=https://axles.example.com:$https
ask() { curl -sS --max-time 60 --cacert certificates/ca.pem --connect-to "::127.0.0.1:" "$@"; }
for _ in $(seq 100); do
  ask -o /dev/null "$url/healthz" 2>/dev/null && break
  sleep 0.1
done
fail() { echo "$1"; cat said log nginx.log; exit 1; }
status() { ask -o said -w '%{http_code}' "$@"; }

[ "$(status -H "$token" "$url/v1/lubricants/paper-fluid-1")" = 200 ] || fail "no lubricant"
[ "$(status "$url/v1/lubricants/paper-fluid-1")" = 401 ] || fail "without a token"
[ "$(status -H "$token" -H 'Origin: https://axles.example.com' "$url/v1/lubricants")" = 200 ] || fail "own origin"
[ "$(status -H "$token" -H 'Origin: https://evil.example' "$url/v1/lubricants")" = 403 ] || fail "foreign origin"
[ "$(status -H "$token" -H 'Content-Type: application/json' "$url/v1/simulations" -d '{"lubricant":
  "lubricants/paper-fluid-1", "operating_point": {"cruise": {"speed_kilometres_per_hour": 60}}}')" = 200 ] ||
  fail "no simulation"
ask -N -H "$token" "$url/v1/simulations/1:watch" >said || fail "no events"
grep -q '^event: end$' said || fail "the events did not end"
ask -D said -o /dev/null -X POST -H "$token" -H 'Content-Length: 0' "$url/session"
grep -qi '^set-cookie: .*; *secure' said || fail "a session's cookie goes without TLS too"
grep -qi '^strict-transport-security: ' said || fail "no HSTS"
[ "$(curl -sS -o said -w '%{http_code}' "http://127.0.0.1:$http/")" = 301 ] || fail "no redirect from HTTP"
ask --tls-max 1.1 --ciphers 'DEFAULT:@SECLEVEL=0' "$url/healthz" >said 2>&1 && fail "TLS 1.1"

export XDG_CONFIG_HOME=$folder TRIBODYN_SERVER=localhost:$grpcs TRIBODYN_CA_FILE=certificates/ca.pem
export TRIBODYN_TOKEN_FILE=oils.sqlite.token
unset TRIBODYN_CONFIG TRIBODYN_PROJECT
"$2" curve --lubricant paper-fluid-1 --plot curve.svg >said 2>&1 || fail "no curve over gRPC"
grep -q '</svg>' curve.svg
