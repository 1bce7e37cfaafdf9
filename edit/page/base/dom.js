// Making and updating elements.

const SVG = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes)) {
        if (name === "style") Object.assign(element.style, value);
        else if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
        else setAttribute(element, name, value);
    }
    element.append(...children.flat().filter((child) => child !== null && child !== undefined));
    return element;
}

/** Sets an attribute if it differs; false, null and undefined remove it. */
export function setAttribute(element, name, value) {
    if (value === false || value === null || value === undefined) {
        if (element.hasAttribute(name)) element.removeAttribute(name);
        return;
    }
    const text = value === true ? "" : String(value);
    if (element.getAttribute(name) !== text) element.setAttribute(name, text);
}

export function setAttributes(element, attributes) {
    for (const [name, value] of Object.entries(attributes)) setAttribute(element, name, value);
}

/** Sets an element's text if it differs, such that screen readers hear of changes alone. */
export function setText(element, text) {
    if (element.textContent !== text) element.textContent = text;
}

/** h("button", {class: "primary", style: {width: "8em"}, onclick: save}, "Save") */
export function h(tag, attributes = {}, ...children) {
    return fill(document.createElement(tag), attributes, children);
}

/** The same for SVG. */
export function svg(tag, attributes = {}, ...children) {
    return fill(document.createElementNS(SVG, tag), attributes, children);
}

/** How much larger things are drawn than on a small screen: the root's font size (style/theme.css). */
export const sizeFactor = () => parseFloat(getComputedStyle(document.documentElement).fontSize) / 16;

export const byId = (id) => document.getElementById(id);

let lastId = 0;

/** An id for an element that others refer to. */
export const newId = (prefix) => `${prefix}-${++lastId}`;
