// Files for the user: the picture and the numbers.

import { h } from "../base/dom.js";
import { numbersQuery } from "../numbers/numbers_feed.js";
import { addressOf } from "../server/api.js";

function download(href, name) {
    const link = h("a", { href, download: name });
    document.body.append(link);
    link.click();
    link.remove();
}

const stemOf = (scene) => scene.scene.replace(/\.[^.]*$/, "");

/** The numbers and curves as a table. */
export function exportNumbers(scene, settings) {
    download(addressOf(`export/numbers.csv${numbersQuery(settings)}`), `${stemOf(scene)}.csv`);
}

/** The total as the server has it, at the size of the scene's image. */
export function exportPicture(scene, settings) {
    const exposure = 2 ** (settings.stops ?? 0);
    download(addressOf(`export/picture.png?exposure=${exposure}`), `${stemOf(scene)}.png`);
}

/** What the canvas shows: the layer looked at, solo and split included. */
export async function exportShown(scene, settings, canvas) {
    const blob = await new Promise((resolve) => { canvas.toBlob(resolve, "image/png"); });
    const href = URL.createObjectURL(blob);
    download(href, `${stemOf(scene)}-${settings.look}.png`);
    setTimeout(() => URL.revokeObjectURL(href), 10000);
}
