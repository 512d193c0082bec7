// In a study the next page comes at the same address when this one is done with: look for it until it is there.

const LOOK_MS = 700;
let isLooking = false;

export const goesOn = window.teachPage.goes_on;

export async function lookForTheNextPage() {
  if (!goesOn || isLooking) return;
  isLooking = true;
  while (isLooking) {
    try {
      const answer = await fetch("/", { cache: "no-store" });
      if (answer.headers.get("Study-Page") === "form") location.replace("/");
    } catch { /* not there yet */ }
    await new Promise((resolve) => setTimeout(resolve, LOOK_MS));
  }
}

export function stopLooking() {
  isLooking = false;
}
