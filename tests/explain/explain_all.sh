#!/bin/sh
# What `cathlab explain` says of many recordings, one after another: name, seconds, processor seconds, verdict.
#   tests/explain/explain_all.sh PROGRAM OUT THREADS DATASET...
# OUT gets a folder a recording, and what was printed beside it.
set -eu
[ $# -ge 4 ] || { echo "usage: $0 PROGRAM OUT THREADS DATASET..." >&2; exit 2; }
program="$1" out="$2" threads="$3"
shift 3
mkdir -p "$out"
for set in "$@"; do
    name=$(basename "$set")
    begin=$(date +%s)
    before=$(cut -d' ' -f16,17 "/proc/$$/stat")
    "$program" explain "$set" --threads "$threads" --out "$out/$name" >"$out/$name.txt" 2>/dev/null || true
    after=$(cut -d' ' -f16,17 "/proc/$$/stat")
    used=$(echo "$before $after" | awk -v t="$(getconf CLK_TCK)" '{ printf "%.0f", ($3 + $4 - $1 - $2) / t }')
    echo "$name, $(($(date +%s) - begin)) s, $used s of processor: $(head -n 1 "$out/$name.txt")"
done
