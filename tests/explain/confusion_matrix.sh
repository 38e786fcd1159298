#!/bin/sh
# The whole confusion matrix of `cathlab explain` on made recordings, as CSV lines and tables for docs/closing-the-loop.md.
#   tests/explain/confusion_matrix.sh BUILD_FOLDER [SEEDS] [KIND]
set -eu
[ $# -ge 1 ] || { echo "usage: $0 BUILD_FOLDER [SEEDS] [KIND]" >&2; exit 2; }
CATHLAB_MATRIX_SEEDS=${2:-3}
export CATHLAB_MATRIX_SEEDS
if [ $# -ge 3 ]; then CATHLAB_MATRIX_KIND=$3; export CATHLAB_MATRIX_KIND; fi
exec "$1/tests/test_explain" --gtest_also_run_disabled_tests --gtest_filter='Confusion.DISABLED_WholeMatrix'
