#!/usr/bin/env bash
# Installs the Python client into a fresh virtual environment, as its README says, and tests it
# against a real tribodynd.
# usage: run.sh TRIBODYND TRIBODYN FOLDER [option of pytest...]
#   FOLDER: where the environment and the caches go
set -euo pipefail
tribodynd=$1 tribodyn=$2 folder=$3
shift 3
tests=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
tree=$(cd "$tests/../../.." && pwd)

export HOME=$folder/home XDG_CONFIG_HOME=$folder/home MPLBACKEND=Agg PYTHONDONTWRITEBYTECODE=1
for variable in CONFIG SERVER TOKEN_FILE CA_FILE CERTIFICATE_FILE KEY_FILE PROJECT OUTPUT TIMEOUT_SECONDS PROGRESS COLOR; do
  unset "TRIBODYN_$variable"
done
mkdir -p "$HOME"
rm -rf "$folder/venv"
# Another python3 on PATH would not find Debian's modules.
/usr/bin/python3 -m venv --system-site-packages --without-pip "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --no-build-isolation --no-deps --no-index \
  --disable-pip-version-check "$tree/client/python"
TRIBODYND=$tribodynd TRIBODYN=$tribodyn TRIBODYN_TREE=$tree TRIBODYN_FOLDER=$folder \
  "$folder/venv/bin/python" -m pytest -q -p no:cacheprovider "$tests" "$@"
