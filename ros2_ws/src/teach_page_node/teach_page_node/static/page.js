// Puts the parts of the page together: what comes from the server is shown, what the person does is sent.

import { connect } from "./live.js";
import { listenToKeys } from "./keys.js";
import { listenToPlayer, showPlayer } from "./player.js";
import { showHistory, showMoments } from "./charts.js";
import { prepareScene, showScene } from "./scene.js";
import { showCloseView } from "./close_view.js";
import { listenToButtons } from "./buttons.js";
import { listenToEnd, showEnd } from "./end.js";
import { showConnection, showPicture, showRole } from "./panel.js";
import { lookForTheNextPage, stopLooking } from "./next_page.js";
import { isMounted } from "./parts.js";

while (!isMounted()) await new Promise((resolve) => setTimeout(resolve, 50)); // NiceGUI builds the page after this is loaded

const isReplay = document.body.classList.contains("replay");

prepareScene();

const PARTS = [(picture) => showPicture(picture, isReplay), showScene, showCloseView, showMoments,
  isReplay ? (picture) => showPlayer(picture.replay) : showEnd];
const failed = new Set();

// A part that cannot be shown must not take the others, or the keys, with it.
function apart(show, picture) {
  try {
    show(picture);
  } catch (error) {
    if (!failed.has(show)) console.error(error);
    failed.add(show);
  }
}

// For whoever measures.
window.teachPage.pictures = 0;

const keys = isReplay ? null : listenToKeys((message) => live.send(message));
const live = connect({
  picture(picture) {
    window.teachPage.pictures += 1;
    window.teachPage.picture = picture;
    for (const show of PARTS) apart(show, picture);
  },
  history: showHistory,
  role(role) {
    keys?.setActive(role.teaches);
    showRole(role, isReplay);
  },
  connection(isUp) {
    if (!isUp) keys?.setActive(false);
    showConnection(isUp);
    if (isUp) stopLooking();
    else lookForTheNextPage();
  },
});

if (isReplay) {
  listenToPlayer(live.send);
} else {
  listenToButtons(live.send);
  listenToEnd(live.send);
}
