-- Editing a drawing in a Neovim with a user interface: every structural edit by its key, and text objects.

local report = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/report.lua')
local check, finish = report.check, report.finish
local nvim = dofile(vim.env.RUNGWISE_TESTS .. '/neovim/ui.lua').start()

local SEAL_IN = {
  '|   X0        X1                           Y0  |',
  '+---| |---+---|/|--------------------------( )-+',
  '|   Y0    |                                    |',
  '+---| |---+                                    |',
}
local PLAIN = { '|   X0                                     Y0  |', '+---| |------------------------------------( )-+' }
local EMPTY = { '|                                              |', '+----------------------------------------------+' }
local TWO = { '|   X0      X1                             Y0  |', '+---| |-----| |----------------------------( )-+' }
local END = { '', '+--[END]---------------------------------------+' }

local function join(...)
  return vim.iter({ ... }):flatten():totable()
end

local function program(lines)
  return table.concat(join(lines, END), '\n')
end

local function same(what, wanted)
  nvim:until_true(what, function()
    return nvim:text() == wanted
  end)
end

--- Each: keys, the drawing before, the cursor (line and column from 0), the drawing afterwards.
local EDITS = {
  { 'insert-contact', '\\cX5<Esc>', SEAL_IN, 1, 14, {
    '|   X0        X5      X1                   Y0  |',
    '+---| |---+---| |-----|/|------------------( )-+',
    SEAL_IN[3], SEAL_IN[4],
  } },
  { 'insert-negated-contact', '\\nX5<Esc>', PLAIN, 1, 5, {
    '|   X5      X0                             Y0  |',
    '+---|/|-----| |----------------------------( )-+',
  } },
  { 'insert-coil', '\\oY1<Esc>', EMPTY, 1, 4, {
    '|                                          Y1  |',
    '+------------------------------------------( )-+',
  } },
  { 'insert-set-coil', '\\sM0<Esc>', EMPTY, 1, 4, {
    '|                                          M0  |',
    '+------------------------------------------(S)-+',
  } },
  { 'insert-reset-coil', '\\rM0<Esc>', EMPTY, 1, 4, {
    '|                                          M0  |',
    '+------------------------------------------(R)-+',
  } },
  { 'insert-box', ':Rungwise edit insert-box MOV K1 D0<CR>', EMPTY, 1, 4, { EMPTY[1], '+--[MOV K1 D0]---------------------------------+' } },
  { 'insert-branch', '\\bX2<Esc>', SEAL_IN, 1, 15, {
    SEAL_IN[1],
    '+---| |---+---|/|---+----------------------( )-+',
    '|   Y0    |   X2    |                          |',
    '+---| |---+---| |---+                          |',
  } },
  { 'insert-rung', '\\g', PLAIN, 1, 5, join(PLAIN, '', EMPTY) },
  { 'insert-rung-above', '\\G', PLAIN, 1, 5, join(EMPTY, '', PLAIN) },
  { 'move-branch-up', '\\k', SEAL_IN, 3, 5, {
    '|   Y0        X1                           Y0  |', SEAL_IN[2], '|   X0    |                                    |', SEAL_IN[4],
  } },
  { 'move-branch-down', '\\j', SEAL_IN, 1, 5, {
    '|   Y0        X1                           Y0  |', SEAL_IN[2], '|   X0    |                                    |', SEAL_IN[4],
  } },
  { 'wrap-in-branch', 'v10l\\pX2<Esc>', TWO, 1, 4, {
    TWO[1],
    '+---| |-----| |---+------------------------( )-+',
    '|   X2            |                            |',
    '+---| |-----------+                            |',
  } },
  { 'delete-element', '\\d', SEAL_IN, 1, 15, {
    '|   X0                                     Y0  |',
    '+---| |---+--------------------------------( )-+',
    SEAL_IN[3], SEAL_IN[4],
  } },
  { 'delete-branch', '\\D', SEAL_IN, 3, 5, {
    '|   X0      X1                             Y0  |',
    '+---| |-----|/|----------------------------( )-+',
  } },
  { 'negate', '\\i', SEAL_IN, 1, 15, {
    SEAL_IN[1], '+---| |---+---| |--------------------------( )-+', SEAL_IN[3], SEAL_IN[4],
  } },
  { 'mend', '\\m', join('|   X10        X1                           Y0  |', vim.list_slice(SEAL_IN, 2)), 0, 4,
    join('|   X10       X1                           Y0  |', vim.list_slice(SEAL_IN, 2)) },
}

for _, script in ipairs(EDITS) do
  local name, keys, before, line, column, after = unpack(script)
  check('the edit ' .. name .. ' by ' .. keys, function()
    nvim:open('edited.lad', program(before), line, column)
    local command, operand = keys:match('^(.-\\%a)(.+)<Esc>$')
    if command then
      -- The name is typed when the placeholder is there and selected.
      nvim:press(command)
      nvim:until_true('the placeholder', function()
        return nvim:request('nvim_get_mode').mode == 's'
      end)
      nvim:type(operand)
      nvim:press('<Esc>')
    else
      nvim:press(keys)
    end
    same('the drawing after ' .. name, program(after))
    if not command then
      nvim:press('u')
      same('one undo of ' .. name, program(before))
    end
  end)
end

--- Each: keys at the cursor, the drawing afterwards.
local OBJECTS = {
  { 'yir and p copy a rung', 'yirGo<Esc>p', 1, 5, join(SEAL_IN, END, '', SEAL_IN) },
  { 'dar deletes a rung', 'dar', 1, 5, { '+--[END]---------------------------------------+' } },
}

for _, script in ipairs(OBJECTS) do
  local name, keys, line, column, after = unpack(script)
  check(name, function()
    nvim:open('objects.lad', program(SEAL_IN), line, column)
    nvim:press(keys)
    nvim:settle()
    same(name, table.concat(after, '\n'))
  end)
end

local RUNG = table.concat(SEAL_IN, '\n') .. '\n'
local NETWORK = RUNG .. table.concat(END, '\n') .. '\n'
--- Each: the object, line and column of the cursor from 0, and what it holds.
local HELD = {
  { 'ie', 1, 15, '|/|' },
  { 'ae', 1, 15, 'X1 \n|/|' },
  { 'ib', 3, 5, 'Y0 \n| |' },
  { 'ab', 3, 5, '   Y0    \n---| |---' },
  { 'ir', 1, 15, RUNG },
  { 'ar', 1, 15, RUNG .. '\n' },
  { 'in', 1, 15, NETWORK },
  { 'an', 1, 15, NETWORK },
}

for _, script in ipairs(HELD) do
  local object, line, column, wanted = unpack(script)
  for _, keys in ipairs({ '"zy' .. object, 'v' .. object .. '"zy' }) do
    check(('the text object %s by %s'):format(object, keys), function()
      nvim:open('held.lad', program(SEAL_IN), line, column)
      nvim:request('nvim_command', 'let @z = ""')
      nvim:press(keys)
      local held = nvim:until_true('the copy', function()
        local copy = nvim:request('nvim_eval', '@z')
        return copy ~= '' and copy
      end)
      assert(held == wanted, vim.inspect(held))
    end)
  end
end

--- A command of the plugin whose placeholder is typed over.
local function inserted(keys, operand)
  nvim:press(keys)
  nvim:until_true('the placeholder', function()
    return nvim:request('nvim_get_mode').mode == 's'
  end)
  nvim:type(operand)
  nvim:press('<Esc>')
  nvim:settle()
end

check('a program is typed from nothing', function()
  nvim:open('typed.lad', table.concat(vim.list_slice(END, 2), '\n'), 0, 3)
  nvim:press('\\G')
  nvim:settle()
  inserted('\\c', 'X10')
  nvim:request('nvim_win_set_cursor', 0, { 2, 40 })
  inserted('\\o', 'Y10')
  nvim:request('nvim_win_set_cursor', 0, { 2, 5 })
  inserted('\\b', 'Y10')
  nvim:request('nvim_win_set_cursor', 0, { 2, 30 })
  inserted('\\n', 'X11')
  nvim:request('nvim_win_set_cursor', 0, { 2, 5 })
  nvim:press('\\g')
  nvim:settle()
  inserted('\\c', 'Y10')
  nvim:request('nvim_win_set_cursor', 0, { 7, 30 })
  nvim:press(':Rungwise edit insert-coil T0 K100<CR>')
  nvim:settle()
  same('the whole program', table.concat({
    '|   X10       X11                          Y10 |',
    '+---| |---+---|/|--------------------------( )-+',
    '|   Y10   |                                    |',
    '+---| |---+                                    |',
    '',
    '|   Y10                                 T0 K100|',
    '+---| |------------------------------------( )-+',
    '',
    '+--[END]---------------------------------------+',
  }, '\n'))
  nvim:until_true('only the timer that nothing reads yet', function()
    return vim.deep_equal(nvim:codes(), { 'written-never-read' })
  end)
end)

--- Each: line and column from 0, keys in Insert mode, and the rows that change.
local BURSTS = {
  { 0, 6, 'X1234', { '|   X0X1234 X1                             Y0  |' } },
  { 0, 27, 'X3', { '|   X0      X1             X3              Y0  |' } },
  { 1, 27, '| |', { TWO[1], '+---| |-----| |------------| |-------------( )-+' } },
  { 1, 24, '[MOV K1 D0]', { TWO[1], '+---| |-----| |---------[MOV K1 D0]--------( )-+' } },
  { 1, 5, '/', { TWO[1], '+---|/|-----| |----------------------------( )-+' } },
}

for _, script in ipairs(BURSTS) do
  local line, column, keys, rows = unpack(script)
  local wanted = program(join(rows, vim.list_slice(TWO, #rows + 1)))
  check(('"%s" is answered key by key, one at a time and all at once'):format(keys), function()
    nvim:open('burst.lad', program(TWO), line, column)
    nvim:press('i')
    nvim:type(keys)
    nvim:press('<Esc>')
    nvim:settle()
    same('the drawing after slow typing', wanted)
    for _ = 1, 3 do
      nvim:press('u')
      same('one undo', program(TWO))
      nvim:request('nvim_win_set_cursor', 0, { line + 1, column })
      nvim:press('i' .. keys)
      nvim:press('<Esc>')
      nvim:settle()
      same('the drawing after a burst', wanted)
    end
    nvim:press('ui' .. keys .. '<Esc>')
    nvim:settle()
    same('the drawing after a burst that leaves Insert mode', wanted)
  end)
end

check('a rung is typed from a snippet, name by name, and a branch by Enter', function()
  local file = vim.fs.joinpath(vim.env.RUNGWISE_TESTS, '../../vscode-extension/snippets/ladder.json')
  local snippets = vim.json.decode(table.concat(vim.fn.readfile(file), '\n'))
  local body
  for _, snippet in pairs(snippets) do
    body = snippet.prefix == 'series' and table.concat(snippet.body, '\n') or body
  end
  nvim:open('snippet.lad', '\n' .. table.concat(vim.list_slice(END, 2), '\n'), 0, 0)
  nvim:press('i')
  nvim:lua('vim.snippet.expand(...)', body)
  for _, name in ipairs({ 'X10', 'Stop', 'Y107' }) do
    nvim:press(name)
    nvim:settle()
    nvim:press('<Tab>')
  end
  nvim:press('<Esc>')
  nvim:settle()
  local rung = { '|   X10     Stop                           Y107|', '+---| |-----| |----------------------------( )-+' }
  same('the rung', table.concat(join(rung, '', END[2]), '\n'))
  nvim:request('nvim_win_set_cursor', 0, { 2, 4 })
  nvim:press('i<CR>')
  nvim:until_true('the name to type over', function()
    return nvim:request('nvim_get_mode').mode == 's'
  end)
  nvim:type('X5')
  nvim:press('<Esc>')
  nvim:settle()
  same('the rung with its branch', table.concat(join({
    '|   X10      Stop                         Y107 |',
    '+---| |---+---| |--------------------------( )-+',
    '|   X5    |                                    |',
    '+---| |---+                                    |',
  }, '', END[2]), '\n'))
end)

--- A rung with a name that is still to be chosen.
local UNNAMED = { (TWO[1]:gsub('X0 ', '???')), TWO[2] }

--- Each: what it is, line and column from 0, the keys behind Enter, the drawing afterwards, that before if it is not TWO.
local ENTERED = {
  { 'a contact, and the name of the branch', 1, 4, 'X17', {
    '|   X0        X1                           Y0  |',
    '+---| |---+---| |--------------------------( )-+',
    '|   X17   |                                    |',
    '+---| |---+                                    |',
  } },
  { 'a contact beside one without a name', 1, 12, 'X17', {
    '|   ???       X1                           Y0  |',
    '+---| |---+---| |---+----------------------( )-+',
    '|         |   X17   |                          |',
    '|         +---| |---+                          |',
  }, UNNAMED },
  { 'the end of a rung, and a contact of the next', 1, 48, '| |', join(TWO, '', EMPTY[1], '+---| |----------------------------------------+') },
}

for _, script in ipairs(ENTERED) do
  local what, line, column, keys, rows, before = unpack(script)
  before = before or TWO
  check('Enter at ' .. what .. ', one key at a time and all at once', function()
    local insert = column == 48 and 'A' or 'i'
    nvim:open('entered.lad', program(before), line, math.min(column, 47))
    nvim:press(insert .. '<CR>')
    nvim:settle()
    nvim:type(keys)
    nvim:press('<Esc>')
    nvim:settle()
    same('the drawing after slow typing', program(rows))
    for _, last in ipairs({ '<Esc>', '' }) do
      nvim:open('entered.lad', program(before), line, math.min(column, 47))
      nvim:press(insert .. '<CR>' .. keys .. last)
      nvim:settle()
      nvim:press('<Esc>')
      same('the drawing after a burst', program(rows))
    end
  end)
end

check('a macro with Enter in it opens a branch wherever it is played, one key at a time and all at once', function()
  local rungs = join(TWO, '', (vim.tbl_map(function(row)
    return (row:gsub('X', 'M'))
  end, TWO)))
  local branch = ENTERED[1][5]
  for _, slow in ipairs({ true, false }) do
    nvim:open('macro.lad', program(rungs), 1, 4)
    nvim:press('qa')
    if slow then
      nvim:press('i<CR>')
      nvim:settle()
      nvim:type('X17')
      nvim:press('<Esc>')
      nvim:settle()
      nvim:press('q')
    else
      nvim:press('i<CR>X17<Esc>q')
      nvim:settle()
    end
    nvim:request('nvim_win_set_cursor', 0, { 7, 4 })
    nvim:press('@a')
    nvim:settle()
    same('both rungs with their branches', program(join(branch, '', (vim.tbl_map(function(row)
      return (row:gsub('X([01]) ', 'M%1 '))
    end, branch)))))
  end
end)

check('deleting a character of a name keeps the columns, and is undone at once', function()
  nvim:open('deleted.lad', program(SEAL_IN), 0, 15)
  nvim:press('x')
  nvim:settle()
  same('the shorter name', program(join('|   X0        X                            Y0  |', vim.list_slice(SEAL_IN, 2))))
  nvim:press('u')
  same('the name again', program(SEAL_IN))
end)

check('a longer name put in by a paste keeps the columns', function()
  nvim:open('pasted.lad', program(SEAL_IN), 0, 14)
  nvim:press('cwX17<Esc>')
  nvim:settle()
  same('the longer name', program(join('|   X0        X17                          Y0  |', vim.list_slice(SEAL_IN, 2))))
end)

nvim:stop()
finish()
