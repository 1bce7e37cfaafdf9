// A value that tells its observers when it changes.

export class Observable {
    #observers = new Set();

    constructor(value) {
        this.value = value;
    }

    set(value) {
        this.value = value;
        for (const observer of [...this.#observers]) observer(value);
    }

    /** Changes some of the keys of an object. */
    update(changes) {
        this.set({ ...this.value, ...changes });
    }

    /** Calls back now, if there is a value, and with each change; returns what ends that. */
    observe(observer) {
        this.#observers.add(observer);
        if (this.value !== null) observer(this.value);
        return () => this.#observers.delete(observer);
    }
}
