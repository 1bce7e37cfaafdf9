// Search without a server: the index is a script, since pages opened from a disk may fetch nothing.
const list = document.querySelector("nav details");
list.open = matchMedia("(min-width: 50rem)").matches;
const entries = new Map(searchIndex.docs.map((entry) => [entry.location, entry]));
const index = lunr(function () {
    this.ref("location");
    this.field("title", {boost: 10});
    this.field("text");
    searchIndex.docs.forEach((entry) => this.add(entry));
});
// A struct's heading is little but its name, which lunr takes for the better match: pages come before
// the reference, which has a place of its own below them.
const isReference = ({ref}) => /^docs\/(cpp|python-reference)\b/.test(ref);
const mostPages = 10, mostOfReference = 6;
const pagesFirst = (found) => [
    ...found.filter((entry) => !isReference(entry)).slice(0, mostPages),
    ...found.filter(isReference).slice(0, mostOfReference)];
document.getElementById("query").addEventListener("input", (event) => {
    const words = lunr.tokenizer(event.target.value).map(String).filter(Boolean);
    const found = words.length === 0 ? [] : index.query((query) => {
        for (const word of words) {
            query.term(word, {boost: 10});
            query.term(word, {wildcard: lunr.Query.wildcard.TRAILING});
        }
    });
    document.getElementById("results").replaceChildren(...pagesFirst(found).map(({ref}) => {
        const link = document.createElement("a");
        link.href = siteRoot + ref;
        link.textContent = entries.get(ref).title;
        const place = document.createElement("small");
        place.textContent = ref.split("#")[0];
        const item = document.createElement("li");
        item.append(link, place);
        return item;
    }));
});
