// Writes the types of the contract's JSON from the text of deploy/contract-text.
// usage: node scripts/types.mjs DESCRIPTORS.txtpb TYPES.ts
// REST's JSON has the names of the protos; 64-bit integers are texts; every field may be missing.
import { readFileSync, writeFileSync } from 'node:fs';

/** Reads protobuf's text format into objects: every field is a list of its values. */
export function parseText(text) {
  const token = /\s+|#[^\n]*|("(?:[^"\\]|\\.)*")|(\[[^\]]*\]|[\w.+-]+)|([{}:;,<>])/gy;
  const tokens = [];
  while (token.lastIndex < text.length) {
    const match = token.exec(text);
    if (match === null) throw new Error('the descriptors cannot be read');
    const word = match[1] ?? match[2] ?? match[3];
    if (word !== undefined) tokens.push(word);
  }
  let place = 0;
  const message = (end) => {
    const out = {};
    while (place < tokens.length && tokens[place] !== end) {
      const name = tokens[place++];
      const values = (out[name] ??= []);
      if (tokens[place] === ':') ++place;
      if (tokens[place] === '{') {
        ++place;
        values.push(message('}'));
      } else {
        let value = tokens[place++];
        if (value.startsWith('"')) {
          value = JSON.parse(value);
          while (tokens[place]?.startsWith('"')) value += JSON.parse(tokens[place++]);
        }
        values.push(value);
      }
    }
    ++place;
    return out;
  };
  return message(undefined);
}

const SCALARS = {
  TYPE_DOUBLE: 'number', TYPE_FLOAT: 'number', TYPE_INT32: 'number', TYPE_UINT32: 'number',
  TYPE_INT64: 'string', TYPE_UINT64: 'string', TYPE_STRING: 'string', TYPE_BYTES: 'string',
  TYPE_BOOL: 'boolean',
};
const OTHERS = {
  '.google.protobuf.Timestamp': 'string', '.google.protobuf.Duration': 'string',
  '.google.protobuf.FieldMask': 'string', '.google.protobuf.Empty': 'Record<string, never>',
};

/** "SimulationState" of ".tribodyn.v1.Simulation.State". */
function typeName(path) {
  if (path in OTHERS) return OTHERS[path];
  if (!path.startsWith('.tribodyn.v1.')) return 'unknown';
  return path.slice('.tribodyn.v1.'.length).replaceAll('.', '');
}

function typeOf(field) {
  const type = SCALARS[field.type[0]] ?? typeName(field.type_name[0]);
  return field.label[0] === 'LABEL_REPEATED' ? `${type}[]` : type;
}

function enumText(type, prefix) {
  const names = (type.value ?? []).map((value) => `'${value.name[0]}'`);
  return `export type ${prefix}${type.name[0]} =\n  | ${names.join('\n  | ')};\n`;
}

function messageText(type, prefix) {
  const name = prefix + type.name[0];
  const fields = (type.field ?? []).map((field) => `  ${field.name[0]}?: ${typeOf(field)};\n`);
  return [
    `export interface ${name} {\n${fields.join('')}}\n`,
    ...(type.enum_type ?? []).map((each) => enumText(each, name)),
    ...(type.nested_type ?? []).map((each) => messageText(each, name)),
  ].join('\n');
}

const [descriptors, out] = process.argv.slice(2);
const parts = ['// Written by scripts/types.mjs from the descriptors of the contract.\n'];
for (const file of parseText(readFileSync(descriptors, 'utf8')).file) {
  if (file.package?.[0] !== 'tribodyn.v1') continue;
  for (const each of file.enum_type ?? []) parts.push(enumText(each, ''));
  for (const each of file.message_type ?? []) parts.push(messageText(each, ''));
}
writeFileSync(out, parts.join('\n'));
