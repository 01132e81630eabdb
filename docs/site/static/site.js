// What the theme leaves out for readers of screens and users of keyboards.
document.addEventListener("DOMContentLoaded", () => {
    for (const caption of document.querySelectorAll("p.caption[role=heading]")) caption.setAttribute("aria-level", "2");
    document.querySelector("aside.sidebar-drawer")?.setAttribute("aria-label", "Pages");
    document.querySelector("aside.toc-drawer")?.setAttribute("aria-label", "On this page");
    // What scrolls can be reached by the keyboard.
    for (const box of document.querySelectorAll("pre, .table-wrapper")) box.tabIndex = 0;
    // Tables whose header says nothing have none.
    for (const head of document.querySelectorAll("thead")) if (head.textContent.trim() === "") head.remove();
    for (const cell of document.querySelectorAll("th")) {
        if (cell.textContent.trim() === "") cell.replaceWith(document.createElement("td"));
    }
    if (!document.querySelector("h1")) {
        const title = document.createElement("h1");
        title.textContent = document.title.split(" - ")[0];
        document.querySelector("article")?.prepend(title);
    }
});
