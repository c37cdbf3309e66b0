// Tables as spreadsheets and catalogues write them: separated by commas, semicolons or tabs.

const DELIMITERS = ["\t", ";", ","];

/** The separator of a table: the one that its first line has most of. */
export function delimiterOf(text) {
  const line = text.replace(/^\ufeff/, "").split(/\r?\n/).find((one) => one.trim()) ?? "";
  const bare = line.replace(/"(?:[^"]|"")*"/g, "");
  const counted = DELIMITERS.map((one) => [bare.split(one).length, one]);
  return counted.reduce((most, one) => (one[0] > most[0] ? one : most))[1];
}

/** The cells of a table, trimmed, without empty lines, and the line in the text that each row begins in. */
export function parse(text, delimiter = delimiterOf(text)) {
  const source = text.replace(/^\ufeff/, "");
  const [rows, lines] = [[], []];
  let [row, cell, quoted, wasQuoted, line, begun] = [[], "", false, false, 1, 1];
  const endCell = () => {
    row.push(wasQuoted ? cell : cell.trim());
    [cell, wasQuoted] = ["", false];
  };
  const endRow = () => {
    endCell();
    if (row.some((one) => one !== "")) {
      rows.push(row);
      lines.push(begun);
    }
    row = [];
    begun = line + 1;
  };
  for (let index = 0; index < source.length; index += 1) {
    const letter = source[index];
    if (quoted) {
      if (letter === "\n") line += 1;
      if (letter !== '"') cell += letter;
      else if (source[index + 1] === '"') cell += source[(index += 1)];
      else quoted = false;
    } else if (letter === '"' && cell.trim() === "" && !wasQuoted) {
      [cell, quoted, wasQuoted] = ["", true, true];
    } else if (letter === delimiter) {
      endCell();
    } else if (letter === "\n" || letter === "\r") {
      if (letter === "\r" && source[index + 1] === "\n") index += 1;
      endRow();
      line += 1;
    } else if (!wasQuoted || letter.trim()) {
      cell += letter;
    }
  }
  endRow();
  return { rows, lines };
}
