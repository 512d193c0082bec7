// One WebSocket: pictures come, keys go. It connects again by itself.

const RETRY_MS = 1000;
const SILENT_MS = 5000;

// The page's name, by which a teacher has the seat again after a reload or a lost connection.
const name = sessionStorage.getItem("page") ?? crypto.getRandomValues(new Uint32Array(2)).join("-");
sessionStorage.setItem("page", name);

export function connect(handlers) {
  let socket = null;
  let heardAt = 0;

  function open() {
    socket = new WebSocket(`${location.protocol === "https:" ? "wss" : "ws"}://${location.host}/live?page=${name}`);
    heardAt = performance.now();
    socket.onmessage = (event) => {
      heardAt = performance.now();
      const message = JSON.parse(event.data);
      for (const [kind, content] of Object.entries(message)) handlers[kind]?.(content);
    };
    socket.onopen = () => handlers.connection(true);
    socket.onclose = () => {
      handlers.connection(false);
      setTimeout(open, RETRY_MS);
    };
  }

  // A server that hangs closes nothing.
  setInterval(() => {
    if (socket.readyState === WebSocket.OPEN && performance.now() - heardAt > SILENT_MS) socket.close();
  }, 500);

  open();
  return {
    send(message) {
      if (socket.readyState === WebSocket.OPEN) socket.send(JSON.stringify(message));
    },
  };
}
