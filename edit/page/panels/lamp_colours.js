// A colour for each lamp, the same wherever it appears. They are told apart without colour vision,
// too, as far as eight can be, and read on dark and on light.

const COLOURS = [
    "#ffb000", "#3fa7ff", "#ff6f91", "#38c793", "#c792ea", "#ff8f4c", "#5fd3e0", "#b7c23a",
];

export const lampColour = (index) => COLOURS[index % COLOURS.length];
