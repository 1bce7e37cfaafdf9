# Sourced by the other scripts.

# Runs a command and shows what it printed only if it fails.
run_quietly() {
    local output
    if ! output=$("$@" 2>&1 </dev/null); then
        tail -n 40 <<<"$output" >&2
        echo "failed: $*" >&2
        return 1
    fi
}

seconds_since() {  # EPOCHREALTIME then
    awk -v a="$1" -v b="$EPOCHREALTIME" 'BEGIN { printf "%.1f", b - a }'
}

# Ends a script that needs a program that is missing, as one that cannot run here.
require() {  # program
    if ! command -v "$1" >/dev/null; then
        echo "$1 is missing" >&2
        exit 77
    fi
}

# Configures and builds a preset, e.g. `build_preset release`; further arguments are those of
# `cmake --build`. Ninja shows the progress.
build_preset() {
    local preset=$1
    shift
    echo "Building the $preset preset"
    run_quietly cmake --preset "$preset"
    cmake --build --preset "$preset" --parallel "$(nproc)" "$@"
}

# Makes the bundle and the wheel of build/release in out, with a Python module for each version of Python.
bundle_release() {
    scripts/install-packages --release
    scripts/python-headers
    run_quietly cmake --preset test -DUWVDB_PYTHON_HEADERS="$PWD/build/python-headers"
    build_preset test
    scripts/bundle
}
