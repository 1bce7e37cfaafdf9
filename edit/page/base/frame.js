// Work that is done once before the next frame of the screen, however often it was asked for.

/** A function that has `work` run before the next frame. Without a request nothing runs. */
export function oncePerFrame(work) {
    let requested = false;
    return () => {
        if (requested) return;
        requested = true;
        requestAnimationFrame(() => {
            requested = false;
            work();
        });
    };
}
