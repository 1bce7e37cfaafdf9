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

# Configures and builds a preset, e.g. `build_preset release`; further arguments are those of
# `cmake --build`. Ninja shows the progress.
build_preset() {
    local preset=$1
    shift
    echo "Building the $preset preset"
    run_quietly cmake --preset "$preset"
    cmake --build --preset "$preset" --parallel "$(nproc)" "$@"
}
