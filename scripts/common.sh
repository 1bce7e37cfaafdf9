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

# Configures and builds a preset, e.g. `build_preset release`. Ninja shows the progress.
build_preset() {
    echo "Building the $1 preset in build/$1"
    run_quietly cmake --preset "$1"
    cmake --build --preset "$1" --parallel "$(nproc)"
}
