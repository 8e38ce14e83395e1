// The socket of a game: numbers messages, comes back when the connection is lost, and says what was refused.
export class Connection {
  constructor(game, receive, trouble) {
    this.game = game;
    this.receive = receive;
    this.trouble = trouble;
    this.tab = Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) => byte.toString(16).padStart(2, "0")).join("");
    this.pause = 500;
    this.begun = false;
    this.open();
  }

  open() {
    const scheme = location.protocol === "https:" ? "wss" : "ws";
    this.socket = new WebSocket(`${scheme}://${location.host}/play/game/${this.game}/live`);
    this.socket.binaryType = "blob";
    this.sent = 0;
    this.socket.onopen = () => {
      this.pause = 500;
      this.send({ type: "hello", tab: this.tab, again: this.begun });
      this.begun = true;
    };
    this.socket.onmessage = ({ data }) => {
      if (typeof data !== "string") return this.receive({ type: "picture", data });
      const message = JSON.parse(data);
      if (message.type !== "error") return this.receive(message);
      if (message.next) this.sent = message.next - 1;
      this.trouble(message.error);
    };
    this.socket.onclose = ({ code }) => {
      if (code === 4401 || code === 4404) return;
      this.trouble({ code: "DISCONNECTED" });
      setTimeout(() => this.open(), this.pause);
      this.pause = Math.min(this.pause * 2, 5000);
    };
  }

  send(message) {
    if (this.socket.readyState !== WebSocket.OPEN) return false;
    this.sent += 1;
    this.socket.send(JSON.stringify({ ...message, n: this.sent }));
    return true;
  }

  takeOver() {
    this.send({ type: "hello", tab: this.tab, again: false });
  }
}
