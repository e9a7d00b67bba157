#!/usr/bin/env bash
# Runs a program against a real tribodynd of its own, whose address is its first argument.
# usage: with_server.sh TRIBODYND PROGRAM [argument...]
# shellcheck source=tests/client/support.sh
. "$(dirname "${BASH_SOURCE[0]}")/support.sh"
shift 2

start_server
"$client" "$TRIBODYN_SERVER" "$@"
