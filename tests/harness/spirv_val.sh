#!/bin/sh
# Holds every compiled kernel to the SPIR-V specification:  spirv_val.sh SPIRV-VAL FOLDER…
set -eu
tool=$1
shift
failed=0 count=0
for module in $(find "$@" -name '*.spv' | sort); do
    count=$((count + 1))
    "$tool" --target-env vulkan1.1 "$module" || { echo "$module: not valid"; failed=1; }
done

# The check must be able to fail: half a module is none.
broken=$(mktemp)
trap 'rm -f "$broken"' EXIT
head -c 64 "$module" >"$broken"
if "$tool" --target-env vulkan1.1 "$broken" 2>/dev/null; then
    echo "spirv-val accepts a truncated module"
    failed=1
fi
echo "$count modules"
exit $failed
