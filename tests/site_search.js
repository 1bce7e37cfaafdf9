// What the site's search finds, without a browser: node site_search.js FOLDER, of scripts/docs-site.
// Pages stand before the reference of C++ and Python, whatever lunr takes for the better match.
const fs = require("fs");
const path = require("path");
const vm = require("vm");

const folder = process.argv[2];
const read = (name) => fs.readFileSync(path.join(folder, name), "utf8");
const listeners = {};
const shown = [];
const element = () => ({children: [], append(...of) { this.children.push(...of); }});
const page = vm.createContext({
    document: {
        querySelector: () => ({open: false}),
        createElement: element,
        getElementById: (id) => id === "query"
            ? {addEventListener: (kind, listener) => { listeners[kind] = listener; }}
            : {replaceChildren: (...items) => { shown.splice(0, shown.length, ...items); }},
    },
    matchMedia: () => ({matches: false}),
    siteRoot: "",
});
vm.runInContext([read("search/lunr.js"), read("search/search_index.js"), read("site.js")].join("\n"),
                page);

let faults = 0;
const expect = (is, what) => {
    if (!is) console.log(`site_search: ${what}`);
    faults += is ? 0 : 1;
};
const isReference = (place) => place.startsWith("docs/cpp") || place === "docs/python-reference.html";
for (const words of ["camera", "port", "volume", "lamp", "calibration", "trajectory", "water", "sky"]) {
    listeners.input({target: {value: words}});
    const places = shown.map((item) => item.children[1].textContent);
    const pages = places.filter((place) => !isReference(place)).length;
    expect(pages > 0, `'${words}' finds no page`);
    expect(pages < places.length, `'${words}' finds nothing of the reference`);
    expect(places.slice(0, pages).every((place) => !isReference(place)),
           `'${words}' has the reference before pages: ${places.join(", ")}`);
}
listeners.input({target: {value: "PoseClock"}});
expect(shown.length > 0, "'PoseClock' is not found in the reference");
listeners.input({target: {value: ""}});
expect(shown.length === 0, "nothing to look for finds something");
process.exit(faults === 0 ? 0 : 1);
