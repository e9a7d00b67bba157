#!/usr/bin/env bash
# Every reason that the sources of core and server give is a value of ErrorReason in the contract,
# and every value is given somewhere.
set -euo pipefail
cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}"
listed=$(grep -oE '^  ERROR_REASON_[A-Z0-9_]+' proto/tribodyn/v1/errors.proto | sed 's/ *ERROR_REASON_//' | sort)
sources=$(find core server -name '*.cpp' -o -name '*.h')
# Texts: of a Refusal, of a status of a contact, of a change of state; and values of the enum.
given=$({
  # shellcheck disable=SC2086
  cat $sources | tr '\n' ' ' |
    grep -oE '(Refusal[({]|mark_failed\(id, options_.clock\(\),|mark_lost\(lease.id, lease.attempt, options_.clock\(\),|lose_attempt\(db, id, attempt, now,|back\(|fail\(lease,|set_refusal\(|reason = ) *"[A-Z][A-Z0-9_]*"' |
    grep -oE '"[A-Z][A-Z0-9_]*"' | tr -d '"'
  sed -n '/^constexpr StatusText kStatusTexts/,/^};/p' core/contact/flank_contact.cpp |
    grep -oE '\{"[A-Z0-9_]+"' | grep -oE '"[A-Z0-9_]+"' | tr -d '"' | grep -vxE 'OK|NO_LOAD'
  # shellcheck disable=SC2086
  cat $sources | grep -oE 'ERROR_REASON_[A-Z0-9_]+' | sed 's/ERROR_REASON_//'
} | grep -v '^$' | sort -u)
unlisted=$(comm -13 <(echo "$listed") <(echo "$given"))
[ -z "$unlisted" ] || { echo "proto/tribodyn/v1/errors.proto lacks:" "$unlisted"; exit 1; }
unused=$(comm -23 <(echo "$listed") <(echo "$given") | grep -vx UNSPECIFIED || true)
[ -z "$unused" ] || { echo "no source gives:" "$unused"; exit 1; }
