--- What of a program is not so in the PLC that is connected: a sign and a word behind each line of it.
local client = require('rungwise.client')
local t = require('rungwise.words').t
local M = {}

local SPACE = vim.api.nvim_create_namespace('rungwise_drift')
--- What differs is asked for once in each pause of typing.
local PAUSE_MS = 300

--- Whether the program of a buffer is in the PLC, by URI: 'same', 'different' or 'unknown'; nothing while none is connected.
M.matches = {}
local is_connected = false
local timer

vim.api.nvim_set_hl(0, 'RungwiseDrift', { default = true, link = 'DiffChange' })
vim.api.nvim_set_hl(0, 'RungwiseDriftWord', { default = true, link = 'Comment' })

local function clear(buffer)
  vim.api.nvim_buf_clear_namespace(buffer, SPACE, 0, -1)
end

local function show(buffer, state)
  M.matches[vim.uri_from_bufnr(buffer)] = state.match
  clear(buffer)
  for _, range in ipairs(state.drift or {}) do
    for line = range.start.line, math.min(range['end'].line, vim.api.nvim_buf_line_count(buffer) - 1) do
      vim.api.nvim_buf_set_extmark(buffer, SPACE, line, 0, {
        sign_text = '≠',
        sign_hl_group = 'RungwiseDrift',
        virt_text = line == range.start.line and { { ' ' .. t('not so in the PLC'), 'RungwiseDriftWord' } } or nil,
      })
    end
  end
  vim.cmd.redrawstatus()
end

local function compare(buffer)
  local server = client.clients(buffer)[1]
  if not server then
    return
  end
  local version = vim.api.nvim_buf_get_changedtick(buffer)
  local asked = { command = 'rungwise.plc.state', arguments = { { uri = vim.uri_from_bufnr(buffer) } } }
  client.request(server, 'workspace/executeCommand', asked, function(err, state)
    local is_as_asked = vim.api.nvim_buf_is_valid(buffer) and vim.api.nvim_buf_get_changedtick(buffer) == version
    if not err and is_connected and is_as_asked then
      show(buffer, state)
    end
  end, buffer)
end

--- Programs that are shown, as buffers.
local function shown()
  local buffers = {}
  for _, window in ipairs(vim.api.nvim_list_wins()) do
    local buffer = vim.api.nvim_win_get_buf(window)
    if vim.list_contains(client.filetypes, vim.bo[buffer].filetype) then
      buffers[buffer] = true
    end
  end
  return vim.tbl_keys(buffers)
end

--- Asks what of the programs that are shown is not in the PLC, once nobody types.
function M.compare_soon()
  if not is_connected then
    return
  end
  if timer then
    timer:stop()
  end
  timer = vim.defer_fn(function()
    timer = nil
    vim.iter(shown()):each(compare)
  end, PAUSE_MS)
end

--- The PLC has said something of itself.
function M.on_state(state)
  is_connected = state.connected
  if is_connected then
    M.compare_soon()
    return
  end
  M.matches = {}
  vim.iter(vim.api.nvim_list_bufs()):filter(vim.api.nvim_buf_is_loaded):each(clear)
end

vim.api.nvim_create_autocmd({ 'TextChanged', 'TextChangedI', 'BufWinEnter' }, {
  group = vim.api.nvim_create_augroup('rungwise_drift', {}),
  callback = M.compare_soon,
})

return M
