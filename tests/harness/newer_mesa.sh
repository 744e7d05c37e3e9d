#!/bin/sh
# Gets the Mesa of the distribution's backports into a folder, beside the installed one, so that the tests can run on both.
#
#   newer_mesa.sh FOLDER GNOMON
#
# Mirror and keyring are those of the machine's own apt configuration. apt keeps its lists and archives in FOLDER, needs no
# root there, and installs nothing: the packages are unpacked to FOLDER/root. FOLDER/env, which with_mesa.sh reads, is written last;
# when it is there, no network is needed. Where no newer Mesa can be had, the exit code is 77, and the last line says why.
set -eu
folder=$1 gnomon=$2
here=$(dirname "$0")
package=mesa-vulkan-drivers

skip() {
    echo "skipped: $*"
    exit 77
}

# Runs GNOMON on the Mesa of FOLDER/env; true if that is the Mesa it reports.
works() {
    "$here/with_mesa.sh" "$folder/env" "$gnomon" devices --json >"$folder/devices.log" 2>&1 &&
        grep -qF "Mesa $(cat "$folder/version")" "$folder/devices.log"
}

# apt-get, with everything that it writes under FOLDER, and no long waits for a network that is not there.
apt_aside() {
    timeout 300 apt-get -q -y -o Dir::Etc::SourceList="$folder/apt/sources.list" -o Dir::Etc::SourceParts=/dev/null \
        -o Dir::State::Lists="$folder/apt/lists" -o Dir::Cache="$folder/apt/cache" -o Dir::Log="$folder/apt/log" \
        -o Debug::NoLocking=true -o APT::Sandbox::User=root -o APT::Install-Recommends=false \
        -o Acquire::http::Timeout=10 -o Acquire::https::Timeout=10 -o Acquire::Retries=1 -o Acquire::Languages=none \
        -o APT::Update::Error-Mode=any \
        "$@" >>"$folder/apt.log" 2>&1 </dev/null
}

# Prints "URI|file:line" of the configured source of a release.
# shellcheck disable=SC2016 # $(RELEASE) and so on are apt's
configured_source() {
    apt-get indextargets --no-release-info --format '$(RELEASE)|$(COMPONENT)|$(REPO_URI)|$(SOURCESENTRY)' |
        awk -F'|' -v release="$1" '$1 == release && $2 == "main" {print $3 "|" $4; exit}'
}

if [ -e "$folder/env" ]; then
    works || { cat "$folder/devices.log"; echo "$folder is damaged; remove it"; exit 1; }
    echo "Mesa $(cat "$folder/version"), unpacked earlier"
    exit 0
fi

command -v apt-get >/dev/null || skip "no apt here to find a newer Mesa with"
codename=$(sed -n 's/^VERSION_CODENAME=//p' /etc/os-release)
[ -n "$codename" ] || skip "/etc/os-release names no release of the distribution"
source=$(configured_source "$codename")
[ -n "$source" ] || skip "apt's configuration has no source for $codename"
uri=${source%%|*} entry=${source#*|}
keyring=$(sed -nE 's/^Signed-By: *(\/.*)/\1/p; s/^deb .*signed-by=([^] ]*).*/\1/p' "${entry%:*}" | head -n 1)

rm -rf "$folder/apt" "$folder/root" "$folder/apt.log"
mkdir -p "$folder/apt/lists/partial" "$folder/apt/cache/archives/partial" "$folder/apt/log" "$folder/root"
for release in "$codename" "$codename-backports"; do
    echo "deb ${keyring:+[signed-by=$keyring] }$uri $release main"
done >"$folder/apt/sources.list"

apt_aside update || skip "cannot read $codename and $codename-backports from the configured mirror (see $folder/apt.log)"
apt_aside install --download-only "$package/$codename-backports" || skip "$codename-backports has no newer $package (see $folder/apt.log)"
archive=$(find "$folder/apt/cache/archives" -name "${package}_*.deb")
[ -n "$archive" ] || skip "$codename-backports has no newer $package than the installed one"
dpkg-deb -f "$archive" Version | sed -E 's/^[0-9]+://; s/[-~+].*//' >"$folder/version"
for archive in "$folder"/apt/cache/archives/*.deb; do
    dpkg-deb -x "$archive" "$folder/root"
done
rm -rf "$folder/apt"

driver=$(find "$folder/root" -name libvulkan_lvp.so)
icd=$(find "$folder/root/usr/share/vulkan/icd.d" -name 'lvp_icd*.json')
if [ -z "$driver" ] || [ -z "$icd" ]; then
    echo "$package $(cat "$folder/version") has no lavapipe"
    exit 1
fi
sed -E "s|(\"library_path\": *)\"[^\"]*\"|\1\"$driver\"|" "$icd" >"$folder/lvp_icd.json"
mkdir -p "$folder/shader_cache"
cat >"$folder/env" <<END
export VK_DRIVER_FILES='$folder/lvp_icd.json'
export VK_ICD_FILENAMES='$folder/lvp_icd.json'
export LD_LIBRARY_PATH='$(dirname "$driver")'
export MESA_SHADER_CACHE_DIR='$folder/shader_cache'
END
works || { cat "$folder/devices.log"; rm "$folder/env"; echo "the unpacked Mesa $(cat "$folder/version") does not work"; exit 1; }
echo "Mesa $(cat "$folder/version") from $codename-backports"
