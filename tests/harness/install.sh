#!/bin/sh
# Installs into an empty prefix, and builds and runs a program against what is there: by pkg-config, and by CMake's find_package.
#
#   install.sh CMAKE GENERATOR CC BUILD FOLDER
set -eu
cmake=$1 generator=$2 cc=$3 build=$4 folder=$5
here=$(cd "$(dirname "$0")" && pwd)
rm -rf "$folder"
"$cmake" --install "$build" --prefix "$folder/prefix" >/dev/null
(cd "$folder/prefix" && find . -type f | sort)

PKG_CONFIG_PATH=$(dirname "$(find "$folder/prefix" -name gnomon.pc)")
LD_LIBRARY_PATH=$(dirname "$PKG_CONFIG_PATH")
export PKG_CONFIG_PATH LD_LIBRARY_PATH
# Not quoted: a list of flags.
# shellcheck disable=SC2046
"$cc" "$here/consumer/consumer.c" -o "$folder/by_pkg_config" $(pkg-config --cflags --libs gnomon)
"$folder/by_pkg_config"

"$cmake" -G "$generator" -S "$here/consumer" -B "$folder/by_cmake" -DCMAKE_PREFIX_PATH="$folder/prefix" -DCMAKE_C_COMPILER="$cc" >/dev/null
"$cmake" --build "$folder/by_cmake" >/dev/null
"$folder/by_cmake/consumer"
"$folder/prefix/bin/gnomon" devices
