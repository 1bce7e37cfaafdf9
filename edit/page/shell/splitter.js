// The bar between picture and plan views, which shares the height between them.

import { setAttributes, sizeFactor } from "../base/dom.js";
import { onDrag } from "../base/dragging.js";

const LEAST = 90; // sixteenths of a rem of the plan views, and of the picture
const KEY_STEP = 20;

export function makeSplitter(bar, main, settings) {
    const set = (height) => {
        const most = main.clientHeight / sizeFactor() - LEAST;
        settings.update({ planHeight: Math.round(Math.min(Math.max(height, LEAST), most)) });
    };
    onDrag(bar, () => {
        const start = settings.value.planHeight;
        return ([, dy]) => set(start - dy / sizeFactor());
    });
    bar.addEventListener("keydown", (event) => {
        const step = { ArrowUp: KEY_STEP, ArrowDown: -KEY_STEP }[event.key];
        if (!step) return;
        event.preventDefault();
        set(settings.value.planHeight + step);
    });
    settings.observe(({ planHeight }) => {
        main.style.setProperty("--plan-height", `${planHeight / 16}rem`);
        setAttributes(bar, { "aria-valuenow": planHeight });
    });
}
