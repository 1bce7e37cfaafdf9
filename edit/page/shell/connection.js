// What comes from the server on its own, handed to whom it concerns; and whether there is one.

import { Events } from "../server/events.js";

export function connect({ sceneFeed, imageFeed, viewFeed, status, banners, suggest, refuse }) {
    const handlers = {
        hello: () => {
            imageFeed.forget();
            viewFeed.forget();
            sceneFeed.fetch();
            imageFeed.fetch();
        },
        state: () => sceneFeed.fetch(),
        image: () => imageFeed.fetch(),
        progress: (event) => status.showProgress(event),
        suggest: (event) => suggest.hear(event),
        error: (event) => refuse(event),
    };
    new Events(handlers, (connection) => {
        status.showConnection(connection === "connected");
        banners.show("server", {
            connected: null,
            gone: "The server does not answer. Is uwvdb edit still running? The page goes on as soon " +
                "as it is.",
            moved: "The server was started anew and has another address now: open the one it printed.",
        }[connection], { kind: "error" });
    });
}
