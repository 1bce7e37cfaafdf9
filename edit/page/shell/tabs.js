// Tabs of the side panel: arrow keys go from one to the next.

import { setAttributes } from "../base/dom.js";

/** `tablist` holds buttons with aria-controls. The chosen tab is part of the settings. */
export function makeTabs(tablist, settings) {
    const tabs = [...tablist.querySelectorAll("[role=tab]")];
    const nameOf = (tab) => tab.dataset.tab;
    const choose = (tab) => {
        settings.update({ tab: nameOf(tab) });
        tab.focus();
    };
    for (const tab of tabs) {
        tab.addEventListener("click", () => choose(tab));
        tab.addEventListener("keydown", (event) => {
            const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
            if (!step) return;
            event.preventDefault();
            choose(tabs[(tabs.indexOf(tab) + step + tabs.length) % tabs.length]);
        });
    }
    settings.observe(({ tab: chosen }) => {
        for (const tab of tabs) {
            const isChosen = nameOf(tab) === chosen;
            setAttributes(tab, { "aria-selected": String(isChosen), tabindex: isChosen ? 0 : -1 });
            document.getElementById(tab.getAttribute("aria-controls")).hidden = !isChosen;
        }
    });
}
