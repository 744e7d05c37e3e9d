#!/bin/sh
# Runs a program on the Mesa that newer_mesa.sh unpacked:  with_mesa.sh FOLDER/env PROGRAM ARGUMENTS…
#
# Exits with 77 (skipped) where there is none, with 1 where the program fails: its own code may be a count that happens to be 77.
if [ ! -e "$1" ]; then
    echo "skipped: no newer Mesa here (see the test newer_mesa)"
    exit 77
fi
# shellcheck disable=SC1090
. "$1"
shift
"$@" || exit 1
