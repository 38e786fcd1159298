#!/bin/sh
# The whole confusion matrix of `cathlab explain` on made recordings, as CSV lines and tables for docs/closing-the-loop.md.
#   tests/explain/confusion_matrix.sh BUILD_FOLDER [SEEDS [THREADS [KIND [EFFECT]]]]
# EFFECT "clean" means those on which nothing acts.
# A line: kind, effect, strength, seed, what was named, hit or miss, both of two effects found, held-out error over the
# noise floor, seconds of one processor.
set -eu
[ $# -ge 1 ] || { echo "usage: $0 BUILD_FOLDER [SEEDS [THREADS [KIND [EFFECT]]]]" >&2; exit 2; }
export CATHLAB_MATRIX_SEEDS="${2:-3}" CATHLAB_MATRIX_THREADS="${3:-1}"
[ $# -lt 4 ] || export CATHLAB_MATRIX_KIND="$4"
[ $# -lt 5 ] || export CATHLAB_MATRIX_EFFECT="$5"
exec "$1/tests/test_explain" --gtest_also_run_disabled_tests --gtest_filter='Confusion.DISABLED_WholeMatrix'
