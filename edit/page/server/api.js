// The server's answers to single requests. Addresses are relative to the page's own, which holds
// the token.

const base = new URL("api/", document.baseURI);

/** An answer that refuses what was asked, in the server's words. */
export class Refusal extends Error {
    constructor(status, message) {
        super(message);
        this.status = status;
    }
}

/** The server did not answer. */
export class Unreachable extends Error {}

export const addressOf = (path) => new URL(path, base).href;

async function request(path, options) {
    let response;
    try {
        response = await fetch(addressOf(path), { cache: "no-store", ...options });
    } catch (error) {
        if (error.name === "AbortError") throw error;
        throw new Unreachable("the server does not answer");
    }
    if (response.ok) return response;
    const text = await response.text();
    let message = text;
    try {
        message = JSON.parse(text).error;
    } catch {
        // Not the server's own words, but those of what stands between: shown as they are.
    }
    throw new Refusal(response.status, message || `the server answers ${response.status}`);
}

export async function get(path, options) {
    return (await request(path, options)).json();
}

export async function post(path, body = {}) {
    const response = await request(path, {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(body),
    });
    return response.json();
}

/** The body as bytes; null if there is nothing new. */
export async function getBytes(path, options) {
    const response = await request(path, options);
    return response.status === 204 ? null : response.arrayBuffer();
}
