// What lamps are, for all that shows them.

/** Whether a lamp stands somewhere, where it can be shown and moved: a sun does not. */
export const hasPlace = (lamp) => lamp.profile.type !== "sun";
