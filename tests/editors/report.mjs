// Counts checks and prints them in the one form that run.sh reads.

/** A list of named checks; a check that throws has failed, the next ones still run. */
export class Report {
  passed = 0;
  failed = 0;

  async check(name, body) {
    const start = performance.now();
    try {
      await body();
      this.pass(name, performance.now() - start);
    } catch (error) {
      this.fail(name, error);
    }
  }

  pass(name, durationMs = 0) {
    this.passed += 1;
    console.log(`ok      ${name} (${Math.round(durationMs)} ms)`);
  }

  fail(name, error) {
    this.failed += 1;
    console.log(`FAILED  ${name}: ${error?.stack ?? error}`);
  }

  /** Prints the summary line and gives the exit code. */
  finish() {
    console.log(`${this.passed} passed, ${this.failed} failed`);
    return this.failed === 0 && this.passed > 0 ? 0 : 1;
  }
}
