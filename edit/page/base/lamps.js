// What lamps are, for all that shows them.

/** Whether a lamp stands somewhere, where it can be shown and moved: suns and glowing volumes do not. */
export const hasPlace = (lamp) => !["sun", "volume"].includes(lamp.profile.type);
