// Sounds of a shot, made from its events: the harder the impact, the louder. Off by default.

const HITS = {  // [Hz] tone, [s] its decay, loudness, share of noise, [m/s] of the loudest
  cue_strike: [900, 0.03, 0.5, 0.5, 8], ball_ball: [2400, 0.025, 0.9, 0.25, 4],
  ball_cluster: [2000, 0.05, 1, 0.4, 4], ball_cushion: [160, 0.09, 0.6, 0.3, 4],
  ball_jaw: [300, 0.05, 0.6, 0.4, 4], ball_pocket: [110, 0.22, 0.8, 0.7, 3],
  ball_out: [90, 0.3, 0.9, 0.8, 3]};

/** {loudness, tone, decay, noise} of an event; null if it is not heard. */
export function soundOf(e) {
  if (!HITS[e.type]) return null;
  const [tone, decay, most, noise, hardest] = HITS[e.type];
  const speed = e.closing ?? e.speed_before ?? e.speed ?? 1, strength = Math.min(speed / hardest, 1);
  return {loudness: most * Math.max(strength, 0.02) ** 0.8, tone, decay, noise};
}

export class Sound {
  constructor() { Object.assign(this, {context: null, played: 0, on: false}); }
  turn(on) {
    this.on = on;
    if (!on || this.context) return;
    this.context = new AudioContext();
    const size = this.context.sampleRate / 2;
    this.hiss = this.context.createBuffer(1, size, this.context.sampleRate);
    const data = this.hiss.getChannelData(0);
    for (let i = 0; i < size; ++i) data[i] = 2 * Math.random() - 1;
  }
  play({loudness, tone, decay, noise}) {
    ++this.played;
    const {context} = this, now = context.currentTime;
    const fading = (share, source) => {
      const gain = context.createGain();
      gain.gain.setValueAtTime(0.4 * loudness * share, now);
      gain.gain.exponentialRampToValueAtTime(1e-4, now + 4 * decay);
      source.connect(gain).connect(context.destination);
      source.start(now);
      source.stop(now + 4 * decay);
    };
    fading(1 - noise, new OscillatorNode(context, {frequency: tone}));
    fading(noise, new AudioBufferSourceNode(context, {buffer: this.hiss}));
  }
}

/** Plays the sounds while the shot runs. */
export function followSounds(state) {
  let before = 0;
  const sound = new Sound();
  state.on("time", () => {
    const {clock, shot} = state, {now, playing} = clock;
    if (sound.on && playing && now > before) {
      const heard = shot.events.filter((e) => e.time > before - (before === 0 ? 1 : 0) && e.time <= now);
      heard.slice(0, 12).map(soundOf).forEach((one) => { if (one) sound.play(one); });
    }
    before = now;
  });
  return sound;
}
