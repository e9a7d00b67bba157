#!/usr/bin/env bash
# Starts a real tribodynd and runs a program with its address as first argument.
# usage: with_server.sh TRIBODYND PROGRAM [argument...]
# shellcheck source=tests/client/support.sh
. "$(dirname "${BASH_SOURCE[0]}")/support.sh"
shift 2

start_server
"$client" "$TRIBODYN_SERVER" "$@"
