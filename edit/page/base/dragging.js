// A drag with the pointer: from where it began, in pixels.

/**
 * Calls `begin(event)` when the pointer goes down on `element`; unless that returns null, what it
 * returns is called as `move([dx, dy], event)` with each movement. `end()` follows in any case.
 */
export function onDrag(element, begin, end = () => {}) {
    element.addEventListener("pointerdown", (event) => {
        if (event.button > 1) return;
        const move = begin(event);
        if (!move) return;
        event.preventDefault();
        event.stopPropagation();
        element.setPointerCapture(event.pointerId);
        const onMove = (moved) =>
            move([moved.clientX - event.clientX, moved.clientY - event.clientY], moved);
        element.addEventListener("pointermove", onMove);
        element.addEventListener("lostpointercapture", () => {
            element.removeEventListener("pointermove", onMove);
            end();
        }, { once: true });
    });
}

/** The step that an arrow key makes on the screen, or null. */
export const arrowStep = (event) =>
    ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] })[event.key] ??
    null;
