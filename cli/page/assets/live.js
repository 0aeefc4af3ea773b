"use strict";
// The page of a run that `relook watch` goes on with: relook_live.js beside it says how many entries there are, and the
// page is read again when it has fewer. What is shown stays: it is in the link.

const live = {
  period: 1000,  // milliseconds

  /** Asks once; a file that is gone ends it. */
  ask() {
    const script = document.createElement("script");
    script.onload = () => script.remove();
    script.onerror = () => script.remove();
    script.src = `relook_live.js?${Date.now()}`;
    document.head.append(script);
  },

  entries() {
    return JSON.parse(document.getElementById("report").textContent).entries;
  },
};

/** Called by relook_live.js. `isLive`: more may come. */
function relook_live(entries, isLive) {
  document.body.dataset.live = isLive ? "yes" : "no";
  if (entries > live.entries()) {
    location.reload();
  } else if (isLive) {
    setTimeout(live.ask, live.period);
  }
}

live.ask();
